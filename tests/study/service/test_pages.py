"""What participants ask for and send, from the first page to the last."""

from rigid.study.service.demographics import QUESTIONS
from rigid.study.service.opening import texts_of
from tests.study.service.serving import CLIPS, HTTP


def test_the_welcome_page_is_for_everybody_and_safe_from_the_title(server):
    answer = HTTP.get(f"{server.address}/")
    assert answer.status_code == 200
    assert "A &lt;small&gt; study" in answer.text


def test_every_answer_allows_nothing_from_elsewhere_and_is_kept_nowhere(server):
    page = server.page(ready=False)
    places = ("/", "/static/study.js", "/nowhere", "/admin/", f"/p/{page.token}",
              f"/p/{page.token}/api/state", f"/p/{'x' * 32}")  # fmt: skip
    for place in places:
        headers = HTTP.get(server.address + place).headers
        assert headers["content-security-policy"].startswith("default-src 'none'; script-src 's")
        assert headers["cache-control"] == "no-store"
        assert headers["referrer-policy"] == "no-referrer"
        assert "server" not in headers


def test_a_link_opens_the_page(server):
    page = server.page(ready=False)
    for link in (page.url, f"{page.url}/"):
        assert HTTP.get(link).text == "<!doctype html>"


def test_a_wrong_link_is_told_in_words(server):
    with server.counting("http:unknown-token"):
        answer = HTTP.get(f"{server.address}/p/{'x' * 32}")
    assert answer.status_code == 401
    assert "This link is not known" in answer.text


def test_consent_comes_first_and_its_sharing_is_kept(server):
    page = server.page("novice", ready=False)
    stage = page.stage()
    assert (stage["kind"], stage["version"]) == ("consent", "1")
    page.post("consent", {"version": "1", "agreed": True, "sharing": True})
    person = server.service.store.participant(page.code)
    assert (person.consent_version, person.sharing) == ("1", True)


def test_a_consent_of_another_version_is_none(server):
    page = server.page("novice", ready=False)
    answer = page.post("consent", {"version": "2", "agreed": True, "sharing": True})
    assert answer.status_code == 409
    assert answer.json()["message"] == "the consent is version 1: reload the page"
    assert server.service.store.participant(page.code).consent_version is None


def test_demographics_may_be_told_or_skipped(server):
    page = server.page("novice", ready=False)
    page.post("consent", {"version": "1", "agreed": True})
    assert page.stage() == {"kind": "demographics", "questions": list(QUESTIONS)}
    told = {"age": 34, "gender": "self-described", "gender_description": "…", "vr_experience": None}
    assert page.post("demographics", told).json()["stage"]["kind"] == "watch"
    kept = server.service.store.participant(page.code).demographics
    assert kept == {"age": 34, "gender": "self-described", "gender_description": "…"}


def test_what_was_watched_is_not_asked_for_again(server):
    page = server.page("novice")
    stage = page.stage()
    assert (stage["episodes"], stage["seen"]) == (["c0", "c1"], 0)
    state = page.post("watched", {"stage": 0, "episode": "c0"}).json()
    assert state["stage"]["seen"] == 1
    page.post("watched", {"stage": 0, "episode": "c1"})
    stage = page.stage()
    assert (stage["kind"], stage["manner"], stage["of"]) == ("practise", "as-watched", 1)


def test_playing_leads_through_the_stages_to_the_end(server):
    page = server.page("novice")
    page.watch()
    with page.live() as live:
        kinds = [live.episode()[0]["kind"] for _ in range(3)]
    assert kinds == ["practise", "play", "play"]
    assert page.stage() == {"kind": "done", "code": None, "url": None}
    assert server.service.store.participant(page.code).status == "done"


def test_what_is_sent_twice_is_taken_once(server):
    page = server.page("watcher")
    for _ in range(2):
        for what, said in (
            ("consent", {"version": "1", "agreed": True, "sharing": True}),
            ("demographics", {"age": 50}),
            ("watched", {"stage": 0, "episode": "c0"}),
            ("watched", {"stage": 0, "episode": "c1"}),
            ("stop", {}),
        ):
            assert page.post(what, said).is_success
    person = server.service.store.participant(page.code)
    assert (person.sharing, person.demographics, person.status) == (False, {}, "done")


def test_a_stage_to_come_takes_nothing(server):
    page = server.page("novice", ready=False)
    answer = page.post("watched", {"stage": 0, "episode": "c0"})
    assert (answer.status_code, answer.json()["error"]) == (409, "not-now")


def test_clips_are_those_that_the_participant_may_see(server):
    page = server.page("novice")
    assert page.get("clip/c1").content == CLIPS[1]
    for key in ("c2", "c-1", "c01x", "..%2fc0"):
        assert page.get(f"clip/{key}").status_code == 404
    assert server.page("player").get("clip/c0").status_code == 404


def test_calibration_is_kept_in_metres(server):
    page = server.page("novice")
    assert page.post("calibration", {"arm_length": 0.71, "seat_height": 0.45}).is_success
    kept = server.service.store.participant(page.code).calibration
    assert kept == {"arm_length": 0.71, "seat_height": 0.45}


def test_who_stopped_can_still_withdraw(server):
    page = server.page("novice")
    assert page.post("stop", {}).json()["can_stop"] is False
    state = page.post("withdraw", {"confirm": "withdraw"}).json()
    assert state["stage"] == {"kind": "withdrawn"}
    assert page.code in server.service.store.withdrawn()


def test_every_question_about_a_person_has_words():
    words = texts_of("en")["demographics"]
    for question in QUESTIONS:
        told = words[question["id"]]
        assert told["label"]
        assert set(question.get("options", ())) <= set(told.get("options", {}))
