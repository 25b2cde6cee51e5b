"""Specula in Python: pictures of models as numpy arrays, shaders that you edit, and every value that they compute.

    import specula
    s = specula.Session("sphere-grid")
    s["material.roughness"] = 0.3
    s.render("d")                    # an array that shows itself in Jupyter
    s.edit("brdf/ndf.glsl", s.read("brdf/ndf.glsl").replace("alpha * alpha", "alpha"))
    s.furnace()
"""

from ._errors import CommandError, CrashError, Diagnostic, ProcessError, ProgramNotFound, ShaderError, SpeculaError
from ._picture import Picture, tile
from ._program import find_program
from ._results import Difference, Furnace, Media, Mode, Probe, Trace, TraceLine
from ._session import Session

__all__ = [
    "CommandError",
    "CrashError",
    "Difference",
    "Diagnostic",
    "Furnace",
    "Media",
    "Mode",
    "Picture",
    "Probe",
    "ProcessError",
    "ProgramNotFound",
    "Session",
    "ShaderError",
    "SpeculaError",
    "Trace",
    "TraceLine",
    "find_program",
    "tile",
]
