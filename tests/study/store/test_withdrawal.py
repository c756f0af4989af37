"""Who withdraws is gone: from every table, and from the bytes of the files."""

import sqlite3
from pathlib import Path

import pytest

from rigid.study.store import GoneError, Store
from rigid.study.store.schema import FILE, LOCK
from tests.study.toys import toy_answer, toy_arrays, toy_plan, toy_record
from tests.toys import ToyReach

TASK = ToyReach(horizon=100)
SECRETS = ("prolific-5c2f", "words-of-their-own", "gpu-of-theirs")


def bytes_of(data: Path) -> bytes:
    return b"".join(path.read_bytes() for path in sorted(data.iterdir()))


def give_everything(store: Store, mark: str) -> tuple[str, list[bytes]]:
    """Somebody who gives whatever one can give; their code, and bytes that only they gave."""
    external, words, device = (f"{secret}-{mark}" for secret in SECRETS)
    code, token = store.invite("novice", external_id=external)
    store.consent(code, "1", sharing=True)
    store.demographics(code, {"gender": "self-described", "gender_description": words})
    store.calibrate(code, {"arm_length": 0.6, "seat_height": 0.5})
    store.watched(code, 0, "c0")
    given = [secret.encode() for secret in (external, words, device)]
    for number in range(2):
        arrays = toy_arrays(TASK, seed=int.from_bytes(f"{mark}{number}".encode()))
        record = toy_record(TASK, code, number, arrays=arrays, about_device={"gpu": device})
        store.begin_attempt(code, "play", number)
        store.add_episode(record, 2)
        stored = arrays.to_bytes()
        given += [stored[at : at + 16] for at in range(0, len(stored) - 16, 300)]
    for number in range(4):
        store.add_answer(toy_answer(code, f"t{number:02}", answered=f"answered-{mark}-{number}"))
        given.append(f"answered-{mark}-{number}".encode())
    written = bytes_of(store.path.parent)
    assert token.encode() not in written
    return code, [part for part in given if part in written]  # Pages split a blob here and there.


@pytest.fixture
def study(tmp_path):
    """Two who gave everything, first one thing of one and then of the other; one withdraws."""
    store = Store.open(tmp_path / "data", toy_plan())
    gone, their = give_everything(store, "gone")
    stays, other = give_everything(store, "stays")
    common = b"".join(record.arrays.to_bytes() for record in store.episodes(stays))
    their = [part for part in their if part not in common]  # Headers, and runs of zeros.
    yield store, gone, their, stays, other
    store.close()


def test_no_byte_of_theirs_is_left_in_any_file(study):
    store, gone, their, _, other = study
    data = store.path.parent
    assert min(len(their), len(other)) > 100
    store.withdraw(gone)
    after = bytes_of(data)
    assert [part for part in their if part in after] == []
    assert [part for part in other if part not in after] == []


def test_no_table_knows_more_than_that_they_withdrew(study):
    store, gone, _, stays, _ = study
    store.withdraw(gone)
    with sqlite3.connect(store.path) as db:
        tables = [row[0] for row in db.execute("SELECT name FROM sqlite_schema WHERE type='table'")]
        rows = [(t, row) for t in tables for row in db.execute(f"SELECT * FROM {t}")]  # noqa: S608 - Our own names.
    db.close()
    assert [table for table, row in rows if gone in row] == ["withdrawn"]
    assert store.withdrawn() == (gone,)
    assert [who.code for who in store.participants()] == [stays]
    assert len(list(store.episodes())) == 2
    with pytest.raises(GoneError, match=f"there is no participant '{gone}'"):
        store.withdraw(gone)


def test_a_reader_who_delays_the_removal_is_told_and_does_not_prevent_it(study):
    store, gone, their, _, _ = study
    data = store.path.parent
    with Store.read(data) as reader, reader.snapshot():
        store.withdraw(gone)
        assert list(store.episodes(gone)) == []  # Deleted, though not scrubbed yet.
        assert not store.scrub()
        assert any(part in bytes_of(data) for part in their)
    assert store.scrub()
    after = bytes_of(data)
    assert [part for part in their if part in after] == []


def test_a_removal_that_was_delayed_is_made_up_for_by_the_next_server(study):
    store, gone, their, _, _ = study
    data = store.path.parent
    with Store.read(data) as reader, reader.snapshot():
        store.withdraw(gone)
        store.close()
    with Store.open(data):
        after = bytes_of(data)
    assert [part for part in their if part in after] == []


def test_withdrawal_beside_a_running_server_reaches_it(study):
    store, gone, their, stays, _ = study
    data = store.path.parent
    with Store.edit(data) as beside:
        beside.withdraw(gone)
    with pytest.raises(GoneError):
        store.add_answer(toy_answer(gone, "t30"))
    store.add_answer(toy_answer(stays, "t30"))
    after = bytes_of(data)
    assert [part for part in their if part in after] == []


def test_withdrawal_of_somebody_who_never_came_deletes_their_link(tmp_path):
    with Store.open(tmp_path, toy_plan()) as store:
        code, token = store.invite("novice", external_id="prolific-9")
        store.withdraw(code)
        assert store.participant_by_token(token) is None
        assert b"prolific-9" not in bytes_of(tmp_path)


def test_freed_pages_are_overwritten_and_given_back_and_no_temporary_file_takes_a_copy(study):
    store, gone, *_ = study
    store.withdraw(gone)
    expected = {"secure_delete": 1, "freelist_count": 0, "temp_store": 2}  # Memory.
    found = {name: store._db.execute(f"PRAGMA {name}").fetchone()[0] for name in expected}
    assert found == expected
    names = {path.name for path in store.path.parent.iterdir()}
    assert names == {FILE, f"{FILE}-wal", f"{FILE}-shm", LOCK}
