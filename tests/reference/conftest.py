"""Makes plants.py importable (tests are no packages), and settles hypothesis."""

import importlib.util
import pathlib
import sys

from hypothesis import settings

settings.register_profile("reference", deadline=None, max_examples=40, derandomize=True)
settings.load_profile("reference")

_specification = importlib.util.spec_from_file_location(
    "reference_plants", pathlib.Path(__file__).with_name("plants.py")
)
_plants = importlib.util.module_from_spec(_specification)
sys.modules["reference_plants"] = _plants
_specification.loader.exec_module(_plants)
