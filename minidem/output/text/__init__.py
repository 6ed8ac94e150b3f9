"""Arrays to the text that LIGGGHTS writes; the engine owns when and where."""

from minidem.output.text.custom import custom_frame as custom_frame
from minidem.output.text.custom import frame_name as frame_name
from minidem.output.text.formats import column_formats as column_formats
from minidem.output.text.stl import stl_file as stl_file
from minidem.output.text.thermo import ThermoFormat as ThermoFormat
from minidem.output.text.thermo import label_of as label_of
from minidem.output.text.thermo import loop_line as loop_line
from minidem.output.text.vtk import bounding_box_file as bounding_box_file
from minidem.output.text.vtk import bounding_box_name as bounding_box_name
from minidem.output.text.vtk import particle_file as particle_file
from minidem.output.text.vtk import vtk_fields as vtk_fields

__all__ = [
    "ThermoFormat",
    "bounding_box_file",
    "bounding_box_name",
    "column_formats",
    "custom_frame",
    "frame_name",
    "label_of",
    "loop_line",
    "particle_file",
    "stl_file",
    "vtk_fields",
]
