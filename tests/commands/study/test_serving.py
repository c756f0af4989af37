"""`rigid study serve`: what it prints, refuses, and finds again."""

import json
import re

import httpx
import pytest

from benchmarks.people.server import StudyServer
from rigid.cli import run
from rigid.study.store import Store
from rigid.tasks.registry import make_task
from tests.study.judging.sources import write_pairs

STUDY = """
title: A study
robots: {a: "builtin:vanilla"}
roles: {player: {participants: 1, stages: [{kind: play}]}}
"""

JUDGING = """
title: A questionnaire
robots: {{a: "builtin:vanilla"}}
demographics: false
roles:
  rater:
    participants: 1
    stages: [{{kind: judge, question: danger, pairs: {pairs}, show: snapshot, count: 4}}]
"""
SCORES = {"goal-left": 3, "goal-right": 4, "danger-left": 0, "danger-right": 7}


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text(STUDY)
    return path


@pytest.fixture
def serve(tmp_path, monkeypatch, capsys):
    """Runs the command up to where it would serve; its exit code, output and errors."""
    monkeypatch.setattr(
        "rigid.study.service.running.serve", lambda service, *_, **__: service.close()
    )

    def call(*options):
        code = run(["study", "serve", "--data", str(tmp_path / "data"), "--port", "0", *options])
        printed = capsys.readouterr()
        return code, printed.out, printed.err

    return call


def test_tokens_are_printed_at_the_first_start_alone(serve, study, tmp_path):
    code, first, _ = serve("--study", str(study))
    assert code == 0
    token = re.search(r"^admin token: (\S+)$", first, re.MULTILINE)[1]
    assert f"/admin/?token={token}\n" in first
    _, again, _ = serve("--study", str(study))
    assert token not in again
    assert "the token is the one of the first start" in again
    with Store.read(tmp_path / "data") as store:
        assert store.is_admin(token)


def test_without_a_study_one_link_is_ready(serve, tmp_path):
    _, printed, _ = serve()
    link = re.search(
        r"^participant P01 \(novice\): http://127.0.0.1:\d+/p/(.+)$", printed, re.MULTILINE
    )
    with Store.read(tmp_path / "data") as store:
        assert store.participant_by_token(link[1]).code == "P01"


def test_a_study_that_was_begun_needs_not_be_named_again(serve, study):
    serve("--study", str(study))
    code, printed, _ = serve()
    assert code == 0
    assert printed.startswith("A study (itch-scratching): http://127.0.0.1:")


def test_the_admins_token_may_come_from_a_file(serve, study, tmp_path):
    file = tmp_path / "token"
    file.write_text("a-token-of-our-own-123\n")
    _, printed, _ = serve("--study", str(study), "--admin-token-file", str(file))
    assert "a-token-of-our-own-123" not in printed
    with Store.read(tmp_path / "data") as store:
        assert store.is_admin("a-token-of-our-own-123")


def test_links_begin_with_the_url_that_participants_use(serve, study):
    _, printed, _ = serve("--study", str(study), "--url", "https://study.example.org/")
    assert "admin page: https://study.example.org/admin/?token=" in printed


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--url", "study.example.org"], "--url 'study.example.org' is no address: write it as"),
        (["--tls-key", "key.pem"], "--tls-key needs its certificate: add --tls-cert FILE.pem"),
        (
            ["--tls-cert", "none.pem"],
            "none.pem is no file: --tls-cert and --tls-key name PEM files",
        ),
        (["--host", "no.such.host.invalid"], "--host 'no.such.host.invalid' is unknown"),
        (["--admin-token-file", "none"], "none does not exist: write a token of 20 to 200 letters"),
    ],
)
def test_a_wrong_option_is_explained(serve, options, told):
    code, printed, errors = serve(*options)
    assert (code, printed) == (2, "")
    assert told in errors


def test_a_file_that_is_no_certificate_is_refused(serve, study):
    code, _, errors = serve("--tls-cert", str(study))
    assert code == 2
    assert "is no certificate with its private key" in errors


def test_a_short_admin_token_is_refused(serve, tmp_path):
    file = tmp_path / "token"
    file.write_text("short")
    code, _, errors = serve("--admin-token-file", str(file))
    assert code == 2
    assert "holds no token: write a token of 20 to 200 letters and digits into it" in errors


def test_as_many_robots_must_be_named_as_the_study_has(serve, study):
    code, _, errors = serve("--study", str(study), "--robot", "builtin:palm", "builtin:vanilla")
    assert code == 2
    assert "--robot names 2 robots, but the study has 1 (a): name as many" in errors


def test_a_study_file_alone_runs_no_code(serve, study):
    study.write_text(STUDY.replace("robots:", 'task: "python:os:getcwd"\nrobots:'))
    code, _, errors = serve("--study", str(study))
    assert code == 2
    assert "runs code: say --trust if you trust whoever wrote the study" in errors


def test_a_language_without_texts_is_refused(serve, study):
    study.write_text(STUDY + "language: tlh\n")
    code, _, errors = serve("--study", str(study))
    assert code == 2
    assert "language 'tlh' has no texts: choose one of en" in errors


@pytest.mark.slow
def test_a_killed_server_goes_on_where_it_was(study, tmp_path):
    with StudyServer(tmp_path / "data", "--study", str(study)) as server:
        (token,) = server.invite("player", 1)
        page = f"{server.address}/p/{token}/api"
        said = {"version": "1", "agreed": True, "sharing": False}
        assert httpx.post(f"{page}/consent", json=said).is_success
        server.kill()
        server.restart()
        assert httpx.get(f"{page}/state").json()["stage"]["kind"] == "demographics"
        assert server.admin("progress")["participants"][0]["status"] == "active"
        assert server.stop() == 130


@pytest.mark.slow
def test_a_killed_server_has_every_answer_that_it_acknowledged(tmp_path):
    pairs = write_pairs(tmp_path, "danger", count=4)
    found = json.loads(pairs.read_text())
    pairs.write_text(json.dumps({**found, "task": make_task("itch-scratching").describe()}))
    study = tmp_path / "study.yaml"
    study.write_text(JUDGING.format(pairs=pairs.name))
    with StudyServer(tmp_path / "data", "--study", str(study)) as server:
        (token,) = server.invite("rater", 1)
        page = f"{server.address}/p/{token}/api"
        httpx.post(f"{page}/consent", json={"version": "1", "agreed": True})
        trials = httpx.get(f"{page}/state").json()["stage"]["trials"]
        for trial in trials[:3]:
            said = {"stage": 0, "trial": trial["id"], "responses": SCORES, "rt": 1.5}
            assert httpx.post(f"{page}/answer", json=said).is_success
            server.kill()
            server.restart()
        stage = httpx.get(f"{page}/state").json()["stage"]
        assert (stage["done"], stage["trials"]) == (3, trials[3:])
        # The page did not hear of the last one, and sends it again.
        assert httpx.post(f"{page}/answer", json=said).is_success
        assert server.admin("progress")["participants"][0]["answers"] == 3 * len(SCORES)
