# SPDX-License-Identifier: MIT
"""block says what a model block holds; what is none, or contradicts itself, is refused."""
import json
import re
import shutil
import zlib
from pathlib import Path

import pytest
from conftest import SOURCE, Program, report_of

SHIPPED = SOURCE / "examples/models/structured_quadrotor.block"
RACER = SOURCE / "tests/models/own_racer.block"


def described(pinnquad, block):
    return json.loads(pinnquad("block --json", block).out)


def test_described(pinnquad):
    """Of the shipped model: as its header says."""
    said, header = described(pinnquad, SHIPPED), SHIPPED.with_suffix(".hpp").read_text()
    assert said["contents_hash"] in header and f'name = "{said["name"]}"' in header
    assert said["network"].replace(" ", "") in header.replace(" ", "").replace("Masked", "Withheld")
    assert said["features"][0] == {**said["features"][0], "name": "s_z", "unit": "m/s^2"}
    assert [output["name"] for output in said["outputs"]] == ["sum", "roll_sum", "pitch_sum", "yaw_sum"]
    assert said["proven"] is True and said["golden_difference"] <= 1e-5
    assert said == {**described(pinnquad, SHIPPED.with_suffix(".hpp")), "model": said["model"]}
    text = pinnquad("block", SHIPPED).out
    assert said["contents_hash"] in text and "s_z [m/s^2]" in text


def test_window_and_column(pinnquad):
    """A model in double, of an airframe of its own, with a window and a column."""
    said = described(pinnquad, RACER)
    assert said["scalar"] == "double" and said["window"]["taps"] > 1 and said["window"]["causal"] is True
    assert [column["name"] for column in said["columns"]] == ["battery_voltage"]
    assert any(feature["name"].endswith("[-1]") for feature in said["features"])


def test_header_of_another_format(pinnquad):
    text = SHIPPED.with_suffix(".hpp").read_text()
    Path("old.hpp").write_text(re.sub(r"( format_version = )\d+;", r"\g<1>3;", text))
    pinnquad.refused("block old.hpp", at="old.hpp", keyword="train and export again), found format 3")


def sealed(block):
    return bytes(block[:-4]) + zlib.crc32(bytes(block[:-4])).to_bytes(4, "little")


@pytest.mark.parametrize("offset, value, keyword", [
    (0, b"X", "another file"), (8, b"\x04", "train and export again"), (8, b"\x02", "found 2"), (12, b"\xff", "bytes that this block records as its length, found "),
    (16, b"\x03", "size"), (20, b"\x11", ""), (28, b"\x01", ""), (40, b"\x00", "hash")])
def test_changed(pinnquad, offset, value, keyword):
    """With its checksum made right again."""
    block = bytearray(SHIPPED.read_bytes())
    block[offset : offset + len(value)] = value
    Path("changed.block").write_bytes(sealed(block))
    pinnquad.refused("block changed.block", at="changed.block", keyword=keyword)


def test_refused(pinnquad, flown):
    whole = SHIPPED.read_bytes()
    Path("cut.block").write_bytes(whole[: len(whole) // 2])
    Path("empty.block").touch()
    Path("weight.block").write_bytes(sealed(bytearray(whole[:-8] + b"\x00\x00\x80\x7f" + whole[-4:])))
    shutil.copy(flown("--seed 9 --samples 500"), "flight.csv")
    for name, keyword in (("cut.block", "cut short"), ("empty.block", "76 bytes or more, found 0"), ("weight.block", "NaN"),
                          ("flight.csv", "model block"), ("none.block", "found none")):
        pinnquad.refused("block", name, at=name, keyword=keyword)


def test_shipped_models_are_of_todays_flights(pinnquad):
    """The blocks of examples/models record the flights that they were trained on: the program makes those today."""
    Program("bash")("", SOURCE / "scripts/models", "--flights", pinnquad, ".")
    for flight, airframe, models in (("flight.csv", "paper_quadrotor", ("demo_quadrotor", "structured_quadrotor")),
                                     ("crazyflie_flight.csv", "crazyflie_2_1", ("crazyflie_2_1",))):
        pinnquad(f"train {flight} --airframe {airframe} --models linear --seeds 1 --allow-poor --out made")
        report = report_of("made")
        (made,), (fold,) = report["settings"]["flights"], report["folds"]
        for model in models:
            said = described(pinnquad, SOURCE / f"examples/models/{model}.block")
            assert said["training_data_hash"] == made["flight_hash"], f"{model} is stale (docs/train.md, 'The models that are shipped')"
            assert said["training_rows"] == fold["rows"]["train"], model
