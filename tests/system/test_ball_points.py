"""`ehdmaps solve` of the contacts of a ball bearing."""

import json

import pytest

from ehdmaps.jobs import cli

_OVER = ("_over_frequency", "_error_over_frequency")
POINT = ["--load", "100 N", "--speed", "3000 rpm", "--temperature", "60 degC"]


def run(capsys, *arguments):
    """Return exit status, stdout and stderr of a command."""
    status = cli.main(["solve", *arguments])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def test_both_contacts_of_a_ball_are_solved_and_drawn(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    status, out, err = run(capsys, "6208", *POINT, "--frequency", "100 Hz", "10 kHz", "3", "--plot", "film.png")
    assert status == 0
    assert "film.png: written" in err and (tmp_path / "film.png").stat().st_size > 20_000
    lines = {line[:20].strip(): line for line in out.splitlines()}
    assert lines["status"].split()[1:] == ["converged", "converged"]
    assert "+-" in lines["central film"] and lines["damping c"].count("%") == 2
    assert out.count("frequency, Hz") == 2


def test_plain_values_have_the_same_numbers(capsys):
    status, out, _ = run(capsys, "--bearing", "6208", "--oil", "ISO VG 46", *POINT, "--json")
    inner, outer = json.loads(out)
    assert status == 0
    assert (inner["contact"], outer["contact"]) == ("inner", "outer")
    assert inner["central_film"] < outer["central_film"] and 0.0 < inner["central_film_error"] < 0.05
    assert inner["ellipticity"] > outer["ellipticity"] > 1.0


def test_films_are_read_from_the_table(capsys):
    """The same numbers as solved ones, within the errors that both state."""
    over = ["--frequency", "100 Hz", "10 kHz", "4"]
    read, solved = (
        json.loads(run(capsys, "6208", *POINT, *over, "--json", *more)[1]) for more in (["--films", "table"], [])
    )
    for one, other in zip(read, solved, strict=True):
        assert one["status"] == "converged" and one["M"] == pytest.approx(other["M"], rel=1e-12)
        for name in ("approach", "film_offset", "central_film", "minimum_film", "stiffness", "damping"):
            error = one[f"{name}_error"] + other[f"{name}_error"]
            assert abs(one[name] / other[name] - 1.0) < error < 0.3, name
        for name in ("stiffness", "damping"):
            values, errors = ([each[f"{name}{end}"] for each in (one, other)] for end in _OVER)
            for a, b, x, y in zip(*values, *errors, strict=True):
                assert abs(a / b - 1.0) < x + y < 0.4, name


def test_no_load_is_told_and_ends_with_status_one(capsys):
    status, out, _ = run(capsys, "6208", "--load", "0 N", *POINT[2:])
    assert status == 1
    assert "inner: no load: the bodies do not meet, no film to solve" in out


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--length", "1 mm"], "--length: is one of line contacts"),
        (["--supply", "2 um"], "--supply: stands beside films that are solved, or a frequency; allowed: --films table"),
        (["--films", "guessed"], "--films: got 'guessed'; allowed: solved, table"),
        (
            ["--films", "table", "--frequency", "90 kHz"],
            "--frequency: got 90000 Hz; allowed beside --films table",
        ),
        (["--films", "table", "--plot", "film.png"], "--plot: stands beside --films table"),
        (["--solver", "formula"], "--solver: got 'formula'; allowed: reynolds, openfoam"),
        (["--frequency", "10 Hz", "1 Hz", "3"], "--frequency: got 10 Hz to 1 Hz; allowed: TO above FROM"),
        (["--oil", "butter"], "--oil: "),
        (["--load", "100 N/mm"], "--load: got the unit 'N/mm'"),
    ],
)
def test_what_balls_do_not_take_is_refused(capsys, more, words):
    status, _, err = run(capsys, "6208", *POINT, *more)
    assert status == 2
    assert words in err


@pytest.mark.parametrize("command", ["check", "report", "tradeoff"])
def test_commands_of_lines_say_what_takes_balls(tmp_path, monkeypatch, capsys, command):
    monkeypatch.chdir(tmp_path)
    assert cli.main([command, "6208-2RS"]) == 2
    assert "6208 is a ball bearing: its contacts are points" in (err := capsys.readouterr().err)
    assert "`ehdmaps generate 6208`" in err and "`mbs bearing 6208 --law films`" in err
