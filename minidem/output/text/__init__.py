"""Arrays to the text that LIGGGHTS writes; the engine owns when and where."""

from minidem.output.text.binary import binary_frame as binary_frame
from minidem.output.text.custom import custom_frame as custom_frame
from minidem.output.text.custom import frame_name as frame_name
from minidem.output.text.formats import column_formats as column_formats
from minidem.output.text.polydata import LINES as LINES
from minidem.output.text.polydata import POLYGONS as POLYGONS
from minidem.output.text.polydata import VERTICES as VERTICES
from minidem.output.text.polydata import PolyData as PolyData
from minidem.output.text.polydata import legacy_file as legacy_file
from minidem.output.text.stl import binary_stl_file as binary_stl_file
from minidem.output.text.stl import stl_file as stl_file
from minidem.output.text.table import format_rows as format_rows
from minidem.output.text.thermo import ThermoFormat as ThermoFormat
from minidem.output.text.thermo import label_of as label_of
from minidem.output.text.thermo import loop_line as loop_line
from minidem.output.text.vtk import bounding_box_file as bounding_box_file
from minidem.output.text.vtk import bounding_box_name as bounding_box_name
from minidem.output.text.vtk import particle_data as particle_data
from minidem.output.text.vtk import particle_file as particle_file
from minidem.output.text.vtk import vtk_fields as vtk_fields
from minidem.output.text.xml import box_file as box_file
from minidem.output.text.xml import parts_file as parts_file
from minidem.output.text.xml import polydata_file as polydata_file
from minidem.output.text.xml import unstructured_file as unstructured_file

__all__ = [
    "LINES",
    "POLYGONS",
    "VERTICES",
    "PolyData",
    "ThermoFormat",
    "binary_frame",
    "binary_stl_file",
    "bounding_box_file",
    "bounding_box_name",
    "box_file",
    "column_formats",
    "custom_frame",
    "format_rows",
    "frame_name",
    "label_of",
    "legacy_file",
    "loop_line",
    "particle_data",
    "particle_file",
    "parts_file",
    "polydata_file",
    "stl_file",
    "unstructured_file",
    "vtk_fields",
]
