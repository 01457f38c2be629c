# SPDX-License-Identifier: MIT
"""setuptools as pyproject.toml calls it, with the setup.py that stands beside this file."""
import shutil

from setuptools.build_meta import _BuildMetaBackend


class _Backend(_BuildMetaBackend):
    def run_setup(self, setup_script="tools/python/setup.py"):
        return super().run_setup(setup_script)


_backend = _Backend()


def get_requires_for_build_wheel(config_settings=None):
    """Asks pip for the programs too that are not in PATH."""
    programs = {"cmake": "cmake>=3.22", "ninja": "ninja"}
    return _backend.get_requires_for_build_wheel(config_settings) + [
        wanted for name, wanted in programs.items() if not shutil.which(name)]


get_requires_for_build_sdist = _backend.get_requires_for_build_sdist
prepare_metadata_for_build_wheel = _backend.prepare_metadata_for_build_wheel
build_wheel = _backend.build_wheel
build_sdist = _backend.build_sdist
