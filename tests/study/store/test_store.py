"""What is stored comes out again, once, and only of those who agreed."""

import sqlite3
import threading
from dataclasses import fields, replace

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.study.records import EpisodeArrays
from rigid.study.store import ConflictError, GoneError, Store
from rigid.study.store.schema import FILE
from tests.study.toys import consented, toy_answer, toy_arrays, toy_plan, toy_record
from tests.toys import ToyReach

TASK = ToyReach()


@pytest.fixture
def store(tmp_path):
    with Store.open(tmp_path / "data", toy_plan()) as opened:
        yield opened


def same(one: EpisodeArrays, other: EpisodeArrays) -> bool:
    pairs = ((getattr(one, f.name), getattr(other, f.name)) for f in fields(EpisodeArrays))
    return all(np.array_equal(a, b) and a.dtype == b.dtype for a, b in pairs)


def test_an_episode_comes_out_as_it_went_in(store):
    code = consented(store)
    record = toy_record(TASK, code, success=np.nan, attempts=2, device="xr-hand")
    assert store.add_episode(record, 2)
    (found,) = store.episodes()
    assert same(found.arrays, record.arrays)
    assert np.isnan(found.success)
    assert replace(found, arrays=record.arrays, success=0.0) == replace(
        record, stage=2, success=0.0
    )


def test_an_answer_comes_out_as_it_went_in(store):
    code = consented(store)
    check = toy_answer(code, "t01", 0.0, pair=None, passed=True)
    assert store.add_answer(check)
    assert store.add_answers([toy_answer(code, "t00", of="first"), toy_answer(code, "t00")])
    assert store.answers() == (
        toy_answer(code, "t00"), toy_answer(code, "t00", of="first"), check,
    )  # fmt: skip


def test_the_same_answer_again_changes_nothing_however_late_it_comes(store):
    code = consented(store)
    store.add_answer(toy_answer(code))
    later = toy_answer(code, rt=9.0, answered="2026-01-05T11:00:00+00:00")
    assert not store.add_answer(later)
    store.finish(code)
    assert not store.add_answer(later)
    assert store.answers() == (toy_answer(code),)


def test_another_answer_to_the_same_trial_is_refused(store):
    code = consented(store)
    store.add_answer(toy_answer(code, response=1.0))
    with pytest.raises(ConflictError, match="P01 answered trial 't00' of stage 1 otherwise before"):
        store.add_answer(toy_answer(code, response=0.0))
    assert store.answers() == (toy_answer(code, response=1.0),)


def test_a_trial_whose_answers_clash_in_part_is_stored_in_no_part(store):
    code = consented(store)
    store.add_answer(toy_answer(code, question="goal", of="first", response=3.0))
    with pytest.raises(ConflictError):
        store.add_answers([
            toy_answer(code, question="goal", of="second", response=5.0),
            toy_answer(code, question="goal", of="first", response=4.0),
        ])  # fmt: skip
    assert [answer.of for answer in store.answers()] == ["first"]


def test_the_same_episode_again_changes_nothing(store):
    code = consented(store)
    record = toy_record(TASK, code)
    assert store.add_episode(record, 2)
    assert not store.add_episode(replace(record, attempts=2), 2)
    assert [found.attempts for found in store.episodes()] == [1]


def test_another_episode_of_the_same_number_is_refused(store):
    code = consented(store)
    record = toy_record(TASK, code)
    store.add_episode(record, 2)
    other = replace(record, arrays=toy_arrays(TASK, seed=1))
    with pytest.raises(ConflictError, match="another play episode 0 of P01 is stored already"):
        store.add_episode(other, 2)
    (found,) = store.episodes()
    assert same(found.arrays, record.arrays)


@pytest.mark.parametrize(
    ("before", "message"),
    [
        pytest.param(lambda *_: None, "P01 has not consented", id="no-consent"),
        pytest.param(
            lambda store, code: (store.consent(code, "1", True), store.stop(code)),
            "P01 has stopped",
            id="stopped",
        ),
        pytest.param(
            lambda store, code: (store.consent(code, "1", True), store.finish(code)),
            "P01 is done",
            id="done",
        ),
        pytest.param(
            lambda store, code: store.withdraw(code), "no participant 'P01'", id="withdrawn"
        ),
    ],
)
@pytest.mark.parametrize(
    "write",
    [
        pytest.param(lambda store: store.add_episode(toy_record(TASK), 2), id="episode"),
        pytest.param(lambda store: store.add_answer(toy_answer()), id="answer"),
        pytest.param(lambda store: store.demographics("P01", {"age": 30}), id="demographics"),
        pytest.param(lambda store: store.calibrate("P01", {"arm_length": 0.6}), id="calibration"),
        pytest.param(lambda store: store.watched("P01", 0, "c0"), id="watched"),
        pytest.param(lambda store: store.begin_attempt("P01", "play", 0), id="attempt"),
    ],
)
def test_nothing_is_stored_of_those_who_have_not_agreed_or_have_left(store, before, message, write):
    before(store, store.invite("novice").code)
    with pytest.raises(GoneError, match=message):
        write(store)
    assert list(store.episodes()) == []
    assert store.answers() == ()


def test_a_token_finds_its_participant_and_is_stored_nowhere(store):
    first, second = store.invite("novice", external_id="prolific-7"), store.invite("novice")
    assert len({first.token, second.token}) == 2
    assert min(len(first.token), len(second.token)) == 32  # 24 bytes, URL-safe.
    found = store.participant_by_token(first.token)
    assert found is not None
    assert (found.code, found.external_id, found.status) == ("P01", "prolific-7", "invited")
    for other in ("", "P01", first.token[:-1], first.token + "\ud800", "' OR 1=1 --"):
        assert store.participant_by_token(other) is None
    written = b"".join(path.read_bytes() for path in store.path.parent.iterdir())
    assert b"prolific-7" in written
    assert first.token.encode() not in written


def test_codes_of_scripts_are_told_from_those_of_people(store):
    kinds = ("person", "scripted", "person")
    assert [store.invite("novice", kind=kind).code for kind in kinds] == ["P01", "S01", "P02"]
    assert [who.kind for who in store.participants()] == ["person", "person", "scripted"]


def test_a_code_is_never_given_again(store):
    store.withdraw(store.invite("novice").code)
    assert store.invite("novice").code == "P02"


def test_the_newest_consent_counts_and_earlier_ones_stay(store):
    code = store.invite("novice").code
    store.consent(code, "1", sharing=True)
    joined = store.participant(code).joined
    store.consent(code, "1", sharing=True)
    store.consent(code, "2", sharing=False)
    found = store.participant(code)
    assert (found.consent_version, found.sharing, found.joined) == ("2", False, joined)
    with sqlite3.connect(store.path) as db:
        rows = db.execute("SELECT version, sharing FROM consents").fetchall()
    db.close()
    assert rows == [("1", 1), ("2", 0)]


def test_places_fill_up_by_consent_and_the_place_of_one_who_withdrew_is_given_again(store):
    store.invite("novice")  # Never comes.
    codes = [consented(store) for _ in range(3)]
    assert [store.participant(code).place for code in codes] == [0, 1, 2]
    assert store.participant(consented(store, "expert")).place == 0
    assert store.participant(consented(store, kind="scripted")).place == 0
    store.withdraw(codes[1])
    assert [store.participant(consented(store)).place for _ in range(2)] == [1, 3]


def test_standing_tells_how_far_somebody_came(store):
    code = store.invite("novice").code
    store.consent(code, "1", sharing=False)
    assert not store.standing(code).demographics_given
    store.demographics(code, {"age": 30, "gender": None})
    store.calibrate(code, {"arm_length": 0.61})
    for episode in ("c0", "c1", "c0"):
        store.watched(code, 0, episode)
    store.add_episode(toy_record(TASK, code), 2)
    store.add_answers([toy_answer(code, of="first"), toy_answer(code, of="second")])
    found = store.standing(code)
    assert found.demographics_given
    assert found.participant.demographics == {"age": 30, "gender": None}
    assert found.participant.calibration == {"arm_length": 0.61}
    assert found.watched == {0: {"c0", "c1"}}
    assert found.played == {2: 1}
    assert found.answered == {1: {"t00"}}


def test_attempts_at_an_episode_are_counted(store):
    code = consented(store)
    assert [store.begin_attempt(code, "play", 0) for _ in range(3)] == [1, 2, 3]
    assert store.begin_attempt(code, "play", 1) == 1
    assert store.begin_attempt(code, "practise", 0) == 1


def test_stopping_keeps_what_was_given_and_does_nothing_to_those_who_are_done(store):
    stopped, done = consented(store), consented(store)
    store.add_answer(toy_answer(stopped))
    store.stop(stopped)
    store.finish(stopped)
    store.finish(done)
    store.stop(done)
    assert [who.status for who in store.participants()] == ["stopped", "done"]
    assert store.answers(stopped) == (toy_answer(stopped),)


def test_progress_counts_what_came_and_what_was_refused(store):
    code, other = consented(store), store.invite("novice").code
    store.add_episode(toy_record(TASK, code), 2)
    store.add_answer(toy_answer(code))
    store.withdraw(store.invite("novice").code)
    store.count_refused("rate")
    store.count_refused("rate", 4)
    store.count_refused("json")
    found = store.progress()
    lines = {line.code: (line.status, line.episodes, line.answers) for line in found.participants}
    assert lines == {code: ("active", 1, 1), other: ("invited", 0, 0)}
    assert found.participants[0].last_seen is not None
    assert found.participants[1].last_seen is None
    assert found.withdrawn == ("P03",)
    assert found.refused == {"json": 1, "rate": 5}


def test_only_the_newest_admin_token_opens(store):
    assert not store.has_admin()
    assert not store.is_admin("")
    store.set_admin_token("one")
    store.set_admin_token("two")
    assert store.has_admin()
    assert [store.is_admin(token) for token in ("one", "two", "")] == [False, True, False]
    assert b"two" not in store.path.read_bytes()


def test_episodes_can_be_picked_by_participant_and_kind(store):
    codes = [consented(store) for _ in range(2)]
    for code in codes:
        for kind, number in (("play", 1), ("play", 0), ("practise", 0)):
            store.add_episode(toy_record(TASK, code, number, kind=kind), 1)
    order = [(found.participant, found.kind, found.number) for found in store.episodes()]
    own = [("practise", 0), ("play", 0), ("play", 1)]
    assert order == [(code, *each) for code in codes for each in own]
    assert len(list(store.episodes(codes[1], "play"))) == 2


def test_a_reader_sees_what_is_committed_and_can_hold_it_still(store):
    consented(store)
    with Store.read(store.path.parent) as reader:
        assert len(reader.participants()) == 1
        with reader.snapshot():
            consented(store)
            assert len(reader.participants()) == 1
        assert len(reader.participants()) == 2


def test_a_reader_cannot_write(store):
    with (
        Store.read(store.path.parent) as reader,
        pytest.raises(UserError, match="attempt to write a readonly database"),
    ):
        reader.invite("novice")


def test_threads_share_a_store(store):
    code = consented(store)

    def answer(first):
        for number in range(first, 40, 4):
            store.add_answer(toy_answer(code, f"t{number:02}"))

    threads = [threading.Thread(target=answer, args=(first,)) for first in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert len(store.answers()) == 40


def test_a_second_server_is_refused_and_may_come_when_the_first_has_gone(tmp_path):
    with (
        Store.open(tmp_path),
        pytest.raises(UserError, match=r"another process serves the study in .*stop it first"),
    ):
        Store.open(tmp_path)
    Store.open(tmp_path).close()


def test_others_on_the_machine_cannot_read_the_data(store):
    consented(store)
    modes = {path.name: path.stat().st_mode & 0o077 for path in store.path.parent.iterdir()}
    assert {FILE, f"{FILE}-wal", f"{FILE}-shm"} < modes.keys()
    assert {modes[name] for name in modes if name.startswith(FILE)} == {0}
    assert store.path.parent.stat().st_mode & 0o077 == 0


def test_what_is_no_study_is_refused(tmp_path):
    with pytest.raises(UserError, match=r"holds no study .*rigid study serve --data"):
        Store.read(tmp_path)
    with pytest.raises(UserError, match="holds no study"):
        Store.edit(tmp_path)
    (tmp_path / FILE).write_bytes(b"no database, but long enough for a header" * 50)
    with pytest.raises(UserError, match=r"is damaged or no study .*restore a backup"):
        Store.open(tmp_path)
    (tmp_path / FILE).unlink()
    with sqlite3.connect(tmp_path / FILE) as db:
        db.execute("CREATE TABLE other (x)")
    db.close()
    with pytest.raises(UserError, match="is a database of something else"):
        Store.open(tmp_path)


def test_a_study_of_a_newer_rigid_is_refused(tmp_path):
    Store.open(tmp_path).close()
    with sqlite3.connect(tmp_path / FILE) as db:
        db.execute("PRAGMA user_version=2")
    db.close()
    with pytest.raises(UserError, match="format version 2, but this RIGID reads up to 1: install"):
        Store.read(tmp_path)


def test_a_full_disk_is_told_and_loses_nothing(store):
    code = consented(store)
    store.add_answer(toy_answer(code))
    pages = store._db.execute("PRAGMA page_count").fetchone()[0]
    store._db.execute(f"PRAGMA max_page_count={pages}").fetchone()
    record = toy_record(ToyReach(horizon=200), code)
    with pytest.raises(UserError, match=r"full.*free space"):
        store.add_episode(record, 2)
    assert store.answers() == (toy_answer(code),)
    store._db.execute("PRAGMA max_page_count=4294967294").fetchone()
    assert store.add_episode(record, 2)
