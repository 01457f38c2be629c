# SPDX-License-Identifier: MIT
"""Builds the module of the Python package pinnquad by CMake; pyproject.toml says the rest."""
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

PACKAGES = ("All that it is built from, on Debian or Ubuntu, as root: apt-get install g++ cmake ninja-build libeigen3-dev "
            "nlohmann-json3-dev libtomlplusplus-dev pybind11-dev python3-dev")
ROOT = Path(__file__).resolve().parents[2]


def version():
    """The one that include/pinnquad/version.hpp states."""
    text = (ROOT / "include/pinnquad/version.hpp").read_text()
    return ".".join(re.search(rf"VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def configure(build):
    lacking = [program for program in ("cmake", "ninja", "c++") if not shutil.which(program)]
    if lacking:
        raise SystemExit(f"pinnquad: no {', '.join(lacking)} in PATH. {PACKAGES}")
    parts = {"TESTS": "OFF", "EXAMPLES": "OFF", "TOOLS": "OFF", "BENCH": "OFF", "LOGS": "ON", "PYTHON": "ON",
             "AT_ONCE": "ON"}
    sets = os.environ.get("PINNQUAD_INSTRUCTION_SETS", "")  # beside any x86-64: docs/packages.md
    from_pip = []
    if importlib.util.find_spec("pybind11"):
        import pybind11
        from_pip = [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
    configured = subprocess.run(
        ["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_POSITION_INDEPENDENT_CODE=ON", "-DPINNQUAD_INSTALL=OFF", f"-DPINNQUAD_INSTRUCTION_SETS={sets}",
         f"-DPython_EXECUTABLE={sys.executable}", *from_pip,
         *[f"-DPINNQUAD_BUILD_{part}={value}" for part, value in parts.items()]],
        stderr=subprocess.PIPE, text=True)
    sys.stderr.write(configured.stderr)
    if configured.returncode:
        # of CMake's error the sentence under "CMake Error at ..."
        said = re.search(r"^CMake Error[^\n]*\n\s*(.+?)\s*(\n\n|\nCall Stack|On Debian|\Z)", configured.stderr, re.S | re.M)
        why = re.sub(r"\s+", " ", said[1]).strip() if said else "CMake fails."
        raise SystemExit(f"pinnquad: {why.removeprefix('pinnquad: ')} {PACKAGES}")


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        # one that stands, whose objects are linked (scripts/lib/python_package.sh)
        tree = os.environ.get("PINNQUAD_BUILD_TREE")
        build = Path(tree or self.build_temp).resolve()
        if not tree:
            configure(build)
        command = ["cmake", "--build", str(build), *(["--target", "pinnquad_python"] if tree else [])]
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(command, check=True, env={**os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": jobs})
        module = Path(self.get_ext_fullpath(ext.name))
        module.parent.mkdir(parents=True, exist_ok=True)
        for built in (build / "python").glob("_core*.so"):
            shutil.copy(built, module.parent)


(ROOT / "build").mkdir(exist_ok=True)
setup(version=version(), license="MIT", options={"egg_info": {"egg_base": "build"}}, cmdclass={"build_ext": CMakeBuild},
      ext_modules=[Extension("pinnquad._core", [])])
