"""Exports say what they are, open in every measurement, and let go of those who withdraw."""

import csv
import hashlib
import json
import shutil

import numpy as np
import pytest

from rigid.cli import run
from rigid.commands.study.exporting import ExportCommand, WithdrawCommand
from rigid.compute.canonical import divide_recorded
from rigid.compute.pairs.recordings import read_recordings
from rigid.data.checking import judge_file
from rigid.data.episodes import load_episodes
from rigid.errors import UserError
from rigid.study.records import EpisodeArrays
from rigid.study.registration import register_study
from rigid.study.service.exports import mend_exports
from rigid.study.store import Store, exports
from rigid.study.store.exports import correct_exports, write_export
from rigid.study.store.tables import COLUMNS, PRIVATE
from tests.study.toys import consented, played_study, toy_answer, toy_arrays, toy_plan, toy_record
from tests.toys import ToyReach

TASK = ToyReach()
PLAN = toy_plan({"a": "builtin:vanilla", "b": "builtin:passive"})


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """P01 and P02 (a mouse), P03 (VR, with robot b, no sharing), and a script."""
    data = tmp_path_factory.mktemp("study") / "data"
    with played_study(data, TASK, PLAN) as store:
        third = store.invite("novice", external_id="=prolific-3").code
        store.consent(third, "1", sharing=False)
        told = {"age": 33, "gender": "self-described", "gender_description": "their words"}
        store.demographics(third, told)
        for number in range(3):
            record = toy_record(TASK, third, number, robot="b", device="xr-hand", success=np.nan)
            store.add_episode(record, 2)
        store.add_answer(toy_answer(third))
        store.stop(third)
        script = consented(store, kind="scripted")
        store.add_episode(toy_record(TASK, script, device="mouse"), 2)
    return data


@pytest.fixture(scope="module")
def exported(finished):
    """What nobody changes."""
    return write_export(finished, finished.parent / "export").path


@pytest.fixture
def data(finished, tmp_path):
    """A copy, before the first export."""
    shutil.copytree(finished, tmp_path / "data")
    with Store.edit(tmp_path / "data") as store, store._writing() as db:
        db.execute("DELETE FROM exports")
    return tmp_path / "data"


@pytest.fixture
def out(data, tmp_path):
    return write_export(data, tmp_path / "export").path


def test_tables_hold_a_line_for_each_and_name_every_column(exported):
    assert [row["code"] for row in rows(exported / "participants.csv")] == [
        "P01",
        "P02",
        "P03",
        "S01",
    ]
    episodes, answers = rows(exported / "episodes.csv"), rows(exported / "answers.csv")
    assert len(episodes) == 2 * (2 + 3) + 3 + 1
    assert [row["manner"] for row in episodes[:5]] == ["as-watched"] * 2 + ["own-way"] * 3
    assert [(row["participant"], row["response"], row["passed"]) for row in answers] == [
        ("P03", "1.0", "")
    ]
    for name, columns in COLUMNS.items():
        header = (exported / name).read_text().splitlines()[0].split(",")
        assert header == list(columns)
        readme = (exported / "README.md").read_text()
        assert [
            column for column in columns if f"| {column} | {columns[column]} |" not in readme
        ] == []


def test_an_episode_is_exported_whole(exported):
    row = next(row for row in rows(exported / "episodes.csv") if row["participant"] == "P03")
    stored = EpisodeArrays.from_bytes((exported / row["file"]).read_bytes())
    expected = toy_record(TASK, "P03", 0, robot="b")
    assert np.array_equal(stored.states, expected.arrays.states)
    assert float(row["episode_return"]) == expected.episode_return
    assert (row["success"], row["device_class"], row["steps"]) == ("", "vr", "10")
    assert json.loads(row["about_device"]) == expected.about_device


def test_practice_is_a_canonical_block_of_its_devices_and_robot(exported):
    files = {path.relative_to(exported).as_posix() for path in exported.glob("canonical/**/*.npz")}
    assert files == {f"canonical/desktop/{name}.npz" for name in ("a", "a/P01", "a/P02")}
    block = load_episodes(exported / "canonical/desktop/a.npz", task=TASK)
    record = toy_record(TASK, "P02", 1, kind="practise")
    assert (len(block), block.source, block.control_period) == (4, "recorded", 0.1)
    for name, expected in (
        ("features", record.arrays.features), ("observations", record.arrays.human_observations),
        ("actions", record.arrays.human_actions), ("rewards", record.arrays.rewards),
        ("returns", record.episode_return), ("success", record.success), ("seeds", record.seed),
        ("times", record.arrays.step_times + 0.1),
    ):  # fmt: skip
        assert np.allclose(getattr(block, name)[3], expected, rtol=1e-6), name
    assert block.about.participants == ("P01", "P02")
    note = block.about.episodes[3]
    assert (note.name, note.device, note.robot) == ("P02-practise-1", "mouse", "a")
    assert block.about.consent is not None
    assert "study 'Toy' (consent 1), but not all to sharing" in block.about.consent


def test_what_each_played_is_one_recording_of_one_human(exported):
    files = {path.relative_to(exported).as_posix() for path in exported.glob("played/**/*.npz")}
    assert files == {
        "played/desktop/a/P01.npz", "played/desktop/a/P02.npz", "played/vr/b/P03.npz",
        "played/scripted/a/S01.npz",
    }  # fmt: skip
    people = sorted(exported.glob("played/*/*/P*.npz"))
    recordings = read_recordings(people, TASK)
    assert [len(recording.episodes) for recording in recordings] == [3, 3, 3]
    assert load_episodes(exported / "played/scripted/a/S01.npz", task=TASK).source == "synthetic"


def test_blocks_pass_the_check_of_data_and_can_be_divided_for_a_measurement(tmp_path):
    played_study(tmp_path / "data", TASK, PLAN, people=6).close()
    write_export(tmp_path / "data", tmp_path / "out")
    path = tmp_path / "out/canonical/desktop/a.npz"
    block = load_episodes(path, task=TASK)
    assert [verdict.reason for verdict in judge_file(block, TASK)] == [""] * 12
    assert len(divide_recorded(block, search=40, folds=3, where=path).search) == 4


def test_episodes_that_ran_away_are_whole_episodes_but_never_canonical(data, tmp_path):
    arrays = toy_arrays(TASK)
    short = {name: value[:4] for name, value in vars(arrays).items()}
    short["states"], short["faulted"] = arrays.states[:5], np.array([False] * 3 + [True])
    with Store.edit(data) as store:
        code = consented(store)
        record = toy_record(
            TASK, code, kind="practise", arrays=EpisodeArrays(**short), episode_return=np.nan
        )
        store.add_episode(record, 1)
    found = write_export(data, tmp_path / "out")
    assert found.written.faulted == 1
    assert (tmp_path / f"out/episodes/{code}-practise-0.npz").exists()
    block = load_episodes(tmp_path / "out/canonical/desktop/a.npz", task=TASK)
    assert block.about.participants == ("P01", "P02")


def test_a_shareable_export_holds_only_who_agreed_and_nothing_that_leads_to_a_person(
    data, tmp_path
):
    out = tmp_path / "shared"
    found = write_export(data, out, shareable=True, licence="CC-BY-4.0")
    assert (found.codes, found.not_shared) == (("P01", "P02", "S01"), ("P03",))
    for name in COLUMNS:
        assert not PRIVATE & set((out / name).read_text().splitlines()[0].split(","))
    everything = b"".join(path.read_bytes() for path in out.rglob("*") if path.is_file())
    for secret in (b"P03", b"prolific-3", b"their words", b"frame_rate", b"10:00:00"):
        assert secret not in everything
    block = load_episodes(out / "canonical/desktop/a.npz", task=TASK)
    assert block.about.licence == "CC-BY-4.0"
    assert "separately that these data may be shared" in (block.about.consent or "")


def test_ages_are_shared_as_spans(tmp_path):
    with Store.open(tmp_path / "data", PLAN) as store:
        register_study(store, PLAN, task=TASK)
        store.demographics(consented(store), {"age": 33, "handedness": "left"})
    write_export(tmp_path / "data", tmp_path / "shared", shareable=True)
    (row,) = rows(tmp_path / "shared/participants.csv")
    assert (row["age"], row["handedness"]) == ("30-34", "left")


def test_a_licence_needs_the_agreement_to_share(data, tmp_path):
    with pytest.raises(UserError, match=r"--licence CC0-1.0 .* add --shareable"):
        write_export(data, tmp_path / "out", licence="CC0-1.0")
    assert not (tmp_path / "out").exists()


def test_a_spreadsheet_runs_nothing_that_a_stranger_wrote(exported):
    assert "'=prolific-3" in (exported / "participants.csv").read_text()


def test_the_manifest_has_a_hash_of_every_file(exported):
    manifest = json.loads((exported / "export.json").read_bytes())
    files = {p.relative_to(exported).as_posix(): p for p in exported.rglob("*") if p.is_file()}
    del files["export.json"]
    assert manifest["complete"]
    assert manifest["files"] == {
        name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items()
    }
    assert manifest["registered"].keys() == {"study", "task", "analysis"}


def test_a_withdrawal_reaches_exports(data, out, tmp_path, capsys):
    write_export(data, tmp_path / "shared", shareable=True)
    (out / "notes.txt").write_text("mine")
    (tmp_path / "shared").rename(tmp_path / "moved")
    assert WithdrawCommand(codes=("P01",), data=data).run() == 0
    told = capsys.readouterr()
    assert f"deleted everything of P01\ntook P01 out of {out}\n" in told.out
    assert "what `rigid study analyze` wrote before counts them still: analyse again" in told.out
    assert f"{tmp_path / 'shared'} held P01, but is no longer there: delete them" in told.err
    assert {path.name for path in out.rglob("*") if "P01" in path.name} == set()
    assert load_episodes(out / "canonical/desktop/a.npz", task=TASK).about.participants == ("P02",)
    assert [row["code"] for row in rows(out / "withdrawn.csv")] == ["P01"]
    assert "P01" not in (out / "episodes.csv").read_text()
    assert (out / "notes.txt").read_text() == "mine"
    assert [found.mended for found in correct_exports(data)] == [False]  # Until somebody finds it.


def test_who_leads_a_study_is_told_that_another_s_export_took_the_place(
    data, out, other, capsys, caplog
):
    shutil.rmtree(out)
    write_export(other, out)
    assert WithdrawCommand(codes=("P01",), data=data).run() == 0
    said = f"{out} held P01, but holds other data's export now: delete them wherever it went"
    assert f"warning: {said}" in capsys.readouterr().err
    mend_exports(data)  # As the server does.
    assert [record.getMessage() for record in caplog.records] == [said]


@pytest.fixture
def other(tmp_path):
    """The data of another study."""
    with played_study(tmp_path / "other", TASK, PLAN):
        return tmp_path / "other"


def test_a_withdrawal_leaves_alone_what_another_study_exported_to_the_place(data, out, other):
    shutil.rmtree(out)
    write_export(other, out)
    before = (out / "export.json").read_bytes()
    with Store.edit(data) as store:
        store.withdraw("P01")
    assert [(found.mended, found.taken) for found in correct_exports(data)] == [(False, True)]
    assert (out / "export.json").read_bytes() == before
    assert "P01" in (out / "episodes.csv").read_text()  # The other study's.


def test_an_export_of_another_study_is_not_overwritten(out, other):
    before = (out / "export.json").read_bytes()
    message = r"export holds an export of another study, or of other data .*: choose a new dir"
    with pytest.raises(UserError, match=message):
        write_export(other, out)
    assert (out / "export.json").read_bytes() == before
    with Store.read(other) as store:
        assert store.exports() == ()


def test_an_export_that_says_nothing_of_its_data_is_written_anew(data, out):
    """As one is that was made before exports said so."""
    manifest = json.loads((out / "export.json").read_text())
    del manifest["data"]
    (out / "export.json").write_text(json.dumps(manifest))
    write_export(data, out)
    assert "data" in json.loads((out / "export.json").read_text())


def test_a_withdrawal_reaches_an_export_that_says_nothing_of_its_data(data, out):
    manifest = json.loads((out / "export.json").read_text())
    del manifest["data"]
    (out / "export.json").write_text(json.dumps(manifest))
    with Store.edit(data) as store:
        store.withdraw("P01")
    assert [found.mended for found in correct_exports(data)] == [True]
    assert "P01" not in (out / "episodes.csv").read_text()


def test_every_export_corrects_the_earlier_ones(data, out, tmp_path, capsys):
    with Store.edit(data) as store:
        store.withdraw("P02")
    assert ExportCommand(data=data, out=tmp_path / "new").run() == 0
    assert f"took P02 out of {out}" in capsys.readouterr().out
    assert "P02" not in (out / "episodes.csv").read_text()


def test_withdrawal_of_nobody_known_deletes_nobody(data, capsys):
    assert run(["study", "withdraw", "P01", "P99", "--data", str(data)]) == 2
    assert "rigid: there is no participant 'P99'" in capsys.readouterr().err
    with Store.read(data) as store:
        assert store.withdrawn() == ()


def test_who_withdraws_while_an_export_is_written_is_not_in_it(data, tmp_path, monkeypatch):
    write_files = exports.write_files

    def slow(store, folder, order):
        if "P01" in [who.code for who in order.people]:
            with Store.edit(data) as beside:
                beside.withdraw("P01")
                assert not beside.scrub()  # The export holds on to it.
        return write_files(store, folder, order)

    monkeypatch.setattr(exports, "write_files", slow)
    found = write_export(data, tmp_path / "out")
    assert found.codes == ("P02", "P03", "S01")
    assert "P01" not in (tmp_path / "out/episodes.csv").read_text()
    with Store.read(data) as store:
        assert store.fact("scrub_pending") is None


def test_withdrawals_that_are_done_leave_nothing_to_do(data, capsys):
    assert WithdrawCommand(data=data).run() == 0
    assert capsys.readouterr().out == "nothing is left of those who withdrew\n"


def test_a_task_that_nobody_described_is_not_imported(tmp_path):
    plan = PLAN.model_copy(update={"task": "python:os:getcwd"})
    Store.open(tmp_path / "data", plan).close()
    with pytest.raises(UserError, match=r"does not describe its task .*serve the study once more"):
        write_export(tmp_path / "data", tmp_path / "out")


def test_an_export_overwrites_nothing_else(data, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "README.md").write_text("mine")
    with pytest.raises(UserError, match=r"thesis is not empty and holds no export .*--out"):
        write_export(data, tmp_path / "thesis")
    assert (tmp_path / "thesis" / "README.md").read_text() == "mine"


def test_an_export_can_be_written_while_the_study_is_served(data, tmp_path):
    with Store.open(data) as store:
        found = write_export(data, tmp_path / "out")
        assert [export.codes for export in store.exports()] == [found.codes]
