"""Arrays to the text that LIGGGHTS writes; the engine owns when and where."""

from minidem.output.custom import custom_frame as custom_frame
from minidem.output.custom import frame_name as frame_name
from minidem.output.formats import column_formats as column_formats
from minidem.output.massflow import massflow_header as massflow_header
from minidem.output.massflow import massflow_rows as massflow_rows
from minidem.output.stl import stl_file as stl_file
from minidem.output.thermo import ThermoFormat as ThermoFormat
from minidem.output.thermo import label_of as label_of
from minidem.output.thermo import loop_line as loop_line
from minidem.output.vtk import bounding_box_file as bounding_box_file
from minidem.output.vtk import bounding_box_name as bounding_box_name
from minidem.output.vtk import particle_file as particle_file
from minidem.output.vtk import vtk_fields as vtk_fields

__all__ = [
    "ThermoFormat",
    "bounding_box_file",
    "bounding_box_name",
    "column_formats",
    "custom_frame",
    "frame_name",
    "label_of",
    "loop_line",
    "massflow_header",
    "massflow_rows",
    "particle_file",
    "stl_file",
    "vtk_fields",
]
