# SPDX-License-Identifier: MIT
"""A project that `new` writes, as its user has it: configured against the installed package that the PATH leads to,
edited, built, run; what it exports is judged by the program, which has none of its types."""
import json
import os
import re
import struct
import zlib
from pathlib import Path

import pytest
from conftest import SOURCE, Program, edited, replaced

PROJECT = "a/b/my_training"


@pytest.fixture(scope="module")
def installed(pinnquad, tmp_path_factory):
    """Where the build tree is installed to."""
    prefix = tmp_path_factory.mktemp("installed")
    Program("cmake")("--install", Path(pinnquad).parents[1], "--prefix", prefix)
    return prefix


@pytest.fixture(scope="module")
def built(installed, flags, compiler, tmp_path_factory):
    """The folder with the project, what it was built to, its flight and what it has exported."""
    folder = tmp_path_factory.mktemp("built")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv("PATH", f"{installed}/bin:{os.environ['PATH']}")
        pinnquad = Program("pinnquad")
        replaced(SOURCE / "examples/airframes/racer_5_inch.toml", "mine.toml", ("^name = .*", 'name = "mine"'))
        pinnquad("fly --airframe mine.toml --seed 3 --samples 3000 --out flight.csv")
        said = pinnquad(f"new {PROJECT} --airframe mine.toml --name MyModel").out
        assert f"cmake -G Ninja -S {PROJECT} -B {PROJECT}/build" in said
        assert sorted(os.listdir(PROJECT)) == ["CMakeLists.txt", "main.cpp", "model.hpp"]
        for name in "CMakeLists.txt", "main.cpp":
            assert not re.search(r"\{\{|\}\};$", Path(PROJECT, name).read_text(),
                                 re.M), "a place of the template is empty"
        replaced(f"{PROJECT}/model.hpp", f"{PROJECT}/model.hpp", ("Hidden<10, 25>", "Hidden<2, 16>"),
                 (", Relu>;", ", Tanh>;"), ("epochs = 300", "epochs = 60"),
                 ("^using MyLoss = .*", "using MyLoss = Mse;"), ("^using MyOptimizer = .*",
                                                                 "using MyOptimizer = Scheduled<AdamW, CosineDecay>;"))
        Program("cmake")(f"-S {PROJECT} -B build -G Ninja", f"-DCMAKE_CXX_COMPILER={compiler}",
                         f"-DCMAKE_CXX_FLAGS={' '.join(flags)}")
        assert f"pinnquad_DIR:PATH={installed}/share/cmake/pinnquad\n" in Path("build/CMakeCache.txt").read_text()
        Program("cmake")("--build build")
        Path("trained.txt").write_text(Program("build/train")("flight.csv out.hpp").out)
    return folder


@pytest.fixture(autouse=True)
def folder(built, work, monkeypatch):
    """Tests read what is linked into their folder."""
    for path in built.iterdir():
        (work / path.name).symlink_to(path)


def test_what_it_exports(pinnquad):
    header = Path("out.hpp").read_text()
    assert re.search("^struct MyModel {", header, re.M) and 'training_data = "flight.csv"' in header
    layers = re.search("using Network = .*(?=;)", header).group().replace("pinnquad::", "")
    assert layers.endswith("Dense<16>, Tanh, Dense<16>, Tanh, Dense<4>>")
    # the program agrees with what the project says of its model
    judged = pinnquad("evaluate out.block --flight flight.csv --rows test --json", code=(0, 1)).out
    said = float(re.search(r"^test rows: R\^2 ([0-9.]*),", Path("trained.txt").read_text(), re.M).group(1))
    assert said > 0 and abs(said - json.loads(judged)["r2"]) < 1e-4


def test_what_it_refuses():
    train = Program("build/train")
    edited("flight.csv", "broken.csv", lambda line, cells: ["0", "fast", *cells[2:]] if line == 9 else None)
    assert train.refused("flight.csv", keyword="OUT.hpp").lines[0].startswith("train: ")
    train.refused("none.csv x.hpp", at="none.csv", keyword="found none")
    train.refused("broken.csv x.hpp", at="broken.csv:9:2")
    train.refused("flight.csv none/out.hpp", at="none/out.hpp", keyword="cannot write")
    assert not Path("x.hpp").exists()


def test_from_an_export(pinnquad):
    pinnquad("new again --model out.hpp")
    again = Path("again/model.hpp").read_text()
    assert "using MyNetwork = Mlp<float, InputSize<16>, Hidden<2, 16>, OutputSize<4>, Tanh>;" in again
    assert '"MyModel"' in Path("again/main.cpp").read_text()
    again, before = again.replace("MyModelAirframe", "OwnAirframe"), Path(PROJECT, "model.hpp").read_text()
    for start in "a.mass_kg = ", r"a.rotors\[3\] = ", "MyAirframe my_airframe":
        assert re.findall(f".*{start}.*", again) == re.findall(f".*{start}.*", before), f"another airframe: {start}"
    pinnquad("new crazyflie --name Tiny --model", SOURCE / "examples/models/crazyflie_2_1.hpp")
    assert "using MyAirframe = Crazyflie;" in Path("crazyflie/model.hpp").read_text()
    assert '"Tiny"' in Path("crazyflie/main.cpp").read_text(), "--name goes before the header's"


def test_another_inertia(pinnquad):
    """An airframe of the library's name and another inertia stands in the project itself."""
    replaced(SOURCE / "examples/airframes/crazyflie_2_1.toml", "own.toml",
             ("^(inertia_kg_m2 = .)1.4e-05", r"\g<1>1.5e-05"))
    pinnquad("fly --airframe own.toml --seed 3 --samples 2200 --out own.csv")
    pinnquad("train --flight own.csv --airframe own.toml --recipe paper --loss vanilla --seeds 1 --epochs 1 "
             "--out own --allow-poor")
    pinnquad("new project --model own/model.hpp")
    project = Path("project/model.hpp").read_text()
    assert "{Scalar(1.5e-05), Scalar(1.4e-05)" in project and "using MyAirframe = GivenAirframe;" in project


@pytest.mark.parametrize("words, at, keyword", [
    ("", "", "folder is required"), ("x/y --name 3rd", "", "--name"), ("x --airframe zeppelin", "", "'zeppelin'"),
    ("x --airframe none.toml", "none.toml", "found none"), ("x --model flight.csv", "flight.csv", "block"),
    ("x --model alone.hpp", "alone.hpp", "alone.block"),
    ("x --model own.hpp", "own.block", "of the library, found `my_own_room::MyFeatures`"),
    (f"x --model {SOURCE}/examples/models/structured_quadrotor.hpp", "structured_quadrotor.block", "a network"),
    (PROJECT, "my_training", "not empty"), ("flight.csv/x", "flight.csv/x", "cannot write"),
    ("flight.csv", "flight.csv", "cannot write")])
def test_refused(pinnquad, words, at, keyword):
    """One line, and no folder, no file."""
    Path("alone.hpp").symlink_to("out.hpp")
    Path("own.hpp").symlink_to("out.hpp")
    block = Path("out.block").read_bytes().replace(b"pinnquad::PaperFeatures", b"my_own_room::MyFeatures")
    Path("own.block").write_bytes(block[:-4] + struct.pack("<I", zlib.crc32(block[:-4])))
    pinnquad.refused(f"new {words}", at=at, keyword=keyword)
    assert not Path("x").exists()


def test_empty_folders(pinnquad):
    os.mkdir("empty")
    pinnquad("new empty")
    os.mkdir("here")
    pinnquad("new .", cwd="here")
    assert Path("here/main.cpp").stat().st_size
    if os.getuid():
        os.mkdir("closed", 0o555)
        pinnquad.refused("new closed/x", at="closed/x", keyword="cannot write")
