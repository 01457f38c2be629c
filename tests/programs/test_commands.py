# SPDX-License-Identifier: MIT
"""The command line itself: commands and their help, --version, completion, manual page, options from a file by
--config."""
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import SOURCE, Program, commands_of, needed, same_bytes


def names_below(commands, command):
    """Of the commands one level below this one."""
    size = len(command.words)
    return [one.words[-1] for one, _ in commands if one.words[:-1] == command.words and len(one.words) == size + 1]


def check_help(commands):
    """Of every command; the names of those without an example."""
    version = (SOURCE / "include/pinnquad/version.hpp").read_text()
    numbers = re.findall(r"^#define PINNQUAD_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", version, re.M)
    program = Path(commands[0][0].words[0]).name
    for command, text in commands:
        assert re.search(r"^Exit codes: 0", text, re.M), command.name
        assert re.search(r"[^0-9]2 bad input", text.replace("\n", " ")), command.name
        if program == "pinnquad":  # one screen
            assert len(text.splitlines()) <= 40 and max(map(len, text.splitlines())) <= 100, command.name
        assert not command("--help").err, command.name
        assert re.fullmatch(rf"{program} {'.'.join(numbers)}\ninstruction set: \w.+\n", command("--version").out)
    shown = rf"^Examples:\n  ({program}|cmake) "
    return [command.name for command, text in commands if not re.search(shown, text, re.M)]


def test_help_and_version_of_the_study(study):
    of_study = commands_of(study)
    assert names_below(of_study, study) == ["paper", "ablation", "beyond", "loop", "wrench"]
    assert len(check_help(of_study)) <= 3


def test_help_and_version(commands):
    assert len(commands) >= 13, [command.name for command, _ in commands]
    assert check_help(commands) == []
    (train,) = [text for command, text in commands if command.words[-1] == "train"]
    assert re.search(r"^  flights FLIGHTS \.\.\.( |$)", train, re.M)


@pytest.mark.parametrize("words, become", [
    ("", None), ("f", "fly"), ("i", "import identify"), ("loop x --air", "--airframe"), ("fly d1 --sam", "--samples"),
    ("train --seeds 3 --conf", "--config"), ("fly d1 --out fi", "")])
def test_completion(pinnquad, commands, words, become):
    script = f"""source {SOURCE}/tools/command_line/completion.bash
        COMP_WORDS=({pinnquad} {words or "''"}) COMP_CWORD={len(words.split()) or 1} COMPREPLY=()
        _pinnquad
        echo "${{COMPREPLY[*]}}" """
    completed = subprocess.run(["bash", "-euc", script], capture_output=True, text=True).stdout
    assert completed == (" ".join(names_below(commands, pinnquad)) if become is None else become) + "\n"


def test_manual_page(commands):
    needed("help2man")
    Program("bash")("", SOURCE / "tools/command_line/manual_page.sh", commands[0][0], "pinnquad.1")
    page = re.sub(r'^(\.SS ".*)', lambda line: line.group(1).replace(r"\-", "-"), Path("pinnquad.1").read_text(), flags=re.M)
    sections = re.findall(r'^\.SH "?(.*?)"?$', page, re.M)
    assert {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "COMMANDS", "OPTIONS FROM A FILE",
            "EXIT STATUS"} <= set(sections), sections
    assert not re.search(r"^(Usage|Commands|Arguments|Options):|^Subcommands", page, re.M), "pieces of --help"
    for command, text in commands[1:]:
        part = re.search(rf'^\.SS "{re.escape(command.name)}"\n(.*?)(?=^\.S[HS])', page + "\n.SH", re.M | re.S)
        part = part.group(1).replace(r"\-", "-")
        for option in set(re.findall(r"^  (--[a-z-]+)", text, re.M)) - {"--version"}:
            assert len(re.findall(rf"^\.B {option}( |$)", part, re.M)) == 1, (command.name, option)
        assert re.search("^Exit codes: 0", part, re.M), command.name
    if shutil.which("man"):
        shown = Program("man")("--warnings -l pinnquad.1", env={"PATH": "/usr/bin:/bin", "LC_ALL": "C",
                                                                "MANWIDTH": "80"})
        assert not shown.err


@pytest.mark.parametrize("words, keyword", [
    ("", "expected a command"), ("land --seed 1", "'land'"), ("--seed 1", "before --seed"),
    ("study", "'study'"), ("airframe", "expected a command"),
    ("fly d1 train --out f.csv", "train"), ("fly d1 --out f.csv --epochs", "--epochs"),
    ("airframe list check", "check"),
    ("train --seeds 1", "expected FLIGHTS")])
def test_refused(pinnquad, commands, words, keyword):
    check_refused(pinnquad, commands, words, keyword)


@pytest.mark.parametrize("words, keyword", [
    ("trian f.csv", "no command named 'trian'; nearest: train"), ("help", "see pinnquad --help"),
    ("train f.csv --epoch 5", "no option --epoch; nearest: --epochs"),
    ("train f.csv --Epochs=5", "no option --Epochs; nearest: --epochs"),
    ("loop m.block --seconds -1", "no option --seconds"), ("train f.csv --epochs ten", "see pinnquad train --help"),
    ("airframe list check", "expected no word more, found 'check'"), ("block", "for example: pinnquad block "),
    ("convert", "for example: pinnquad convert "), ("replay f.ulg", "for example: pinnquad replay "),
    ("benchmark", "for example: pinnquad benchmark "), ("fly d1", "pinnquad fly d1 --out d1.csv"),
    ("loop", "pinnquad loop my_model/model.block"), ("import f.ulg", "--out dataset"),
    ("train none.csv", "see pinnquad train --help")])
def test_a_mistake_of_the_first_hour(pinnquad, words, keyword):
    """The line names what was meant, or what to type next."""
    pinnquad.refused(words, keyword=keyword)


@pytest.mark.parametrize("words, instead", [
    ("train --flight f.csv", "train ... FLIGHTS"), ("train --log=f.csv", "train ... LOGS --mapping"),
    ("identify --dataset d", "identify ... DIR"), ("evaluate --model m.block f.csv", "evaluate ... MODEL"),
    ("evaluate m.block --flight f.csv", "evaluate ... FLIGHTS"), ("train f.csv --recipe best", "train ... --models"),
    ("train f.csv --loss vanilla", "train ... --models")])
def test_options_of_earlier_versions(pinnquad, words, instead):
    pinnquad.refused(words, keyword=f"; write: {instead}")


@pytest.mark.parametrize("words, keyword", [
    ("", "expected a command"), ("news", "'news'"), ("paper --out o ablation", "ablation")])
def test_refused_by_the_study(study, words, keyword):
    check_refused(study, commands_of(study), words, keyword)


def check_refused(program, commands, words, keyword):
    line = program.refused(words, keyword=keyword).lines[0]
    if "expected a command" in line or "known" in line:  # it lists what there is
        group = Program(program, *[word for word in words.split()[:1] if word == "airframe"])
        listed = re.search(r"(?:known|: expected a command[^:]*): (.*?)( \(|;|$)", line).group(1)
        assert listed.split(", ") == names_below(commands, group)
    assert not Path("o").exists()


OPTIONS = """[fly]
flight = "d3"
seed = 4
samples = 50
max-speed = 5.5

[train]
flights = ["a.csv", "b.csv"]
allow-poor = true

"""


def test_options_from_a_file(pinnquad):
    """They fly the same flight; the command line goes first; --config may stand before the command or behind."""
    Path("options.toml").write_text(OPTIONS)
    pinnquad("fly d3 --seed 4 --samples 50 --max-speed 5.5 --out words.csv")
    pinnquad("fly --config options.toml --out behind.csv")
    pinnquad("--config options.toml fly --out before.csv")
    same_bytes("words.csv", "behind.csv")
    same_bytes("words.csv", "before.csv")
    pinnquad("fly d3 --seed 5 --samples 50 --max-speed 5.5 --out words.csv")
    pinnquad("fly --seed 5 --config options.toml --out both.csv")
    same_bytes("words.csv", "both.csv")
    pinnquad.refused("train --config options.toml --out o", at="a.csv", keyword="found none")
    pinnquad.refused("fly --config none.toml --out w.csv", at="none.toml", keyword="found none")


@pytest.mark.parametrize("place, keyword, text", [
    ("2:8", "--seed", "[fly]\nseed = -1"), ("2:13", "--max-speed", "[fly]\nmax-speed = 20"),
    ("2:1", "`sed`", "[fly]\nsed = 1"), ("2:1", "`help`", "[fly]\nhelp = true"), ("1:2", "`land`", "[land]\nseed = 1"),
    ("2:8", "truth value", "[fly]\nseed = true"), ("2:18", "true or false", "[fly]\nlist-airframes = 1"),
    ("2:9", "array", "[fly]\nseed = [[]]"), ("2:6", "TOML", "[fly]\nseed 3"),
    ("2:10", "--epochs", "[train]\nepochs = 0")])
def test_wrong_file(pinnquad, place, keyword, text):
    Path("wrong.toml").write_text(text + "\n")
    pinnquad.refused("fly --config wrong.toml --samples 20 --out w.csv", at=f"wrong.toml:{place}", keyword=keyword)
    assert not Path("w.csv").exists()
