"""The desk of whoever runs the study is closed to everybody else."""

import io
import zipfile

import httpx
import pytest

from tests.study.service.serving import ADMIN, HTTP

BEARER = {"Authorization": f"Bearer {ADMIN}"}


@pytest.mark.parametrize(
    "path", ["/", "/admin.js", "/admin.css", "/api/progress", "/api/export", "/nowhere", "/../x"]
)
def test_nothing_opens_without_the_token(server, path):
    answer = HTTP.get(f"{server.address}/admin{path}", follow_redirects=True)
    assert answer.status_code in {401, 404}
    assert answer.status_code == 401 or "/admin" not in str(answer.url)


def test_who_comes_without_the_link_sees_a_page_that_says_where_it_is(server):
    for place in ("/admin", "/admin/"):
        answer = HTTP.get(f"{server.address}{place}", follow_redirects=True)
        assert answer.status_code == 401
        assert answer.headers["content-type"].startswith("text/html")
        assert "Please open the admin link that was printed" in answer.text
        assert "--admin-token-file" in answer.text


def test_programs_without_the_token_are_told_in_json(server):
    answer = HTTP.get(f"{server.address}/admin/api/progress")
    assert answer.json()["error"] == "unknown-token"
    assert answer.headers["www-authenticate"] == "Bearer"


def test_a_link_without_its_slash_leads_to_the_page(server):
    answer = HTTP.get(f"{server.address}/admin", params={"token": ADMIN})
    assert (answer.status_code, answer.headers["location"]) == (307, f"/admin/?token={ADMIN}")


@pytest.mark.parametrize("token", ["x", ADMIN[:-1], ADMIN + "x", "x" * 5000])
def test_another_token_opens_nothing(server, token):
    headers = {"Authorization": f"Bearer {token}"}
    with server.counting("admin:unknown-token", 2):
        assert HTTP.get(f"{server.address}/admin/", headers=headers).status_code == 401
        assert HTTP.get(f"{server.address}/admin/", params={"token": token}).status_code == 401


def test_a_participants_token_is_not_the_admins(server):
    headers = {"Authorization": f"Bearer {server.page().token}"}
    assert HTTP.get(f"{server.address}/admin/api/progress", headers=headers).status_code == 401


def test_the_link_leaves_a_cookie_that_scripts_and_other_sites_cannot_use(server):
    with httpx.Client() as client:
        answer = client.get(f"{server.address}/admin/", params={"token": ADMIN})
        assert answer.status_code == 200
        cookie = answer.headers["set-cookie"].lower()
        assert "httponly" in cookie
        assert "samesite=strict" in cookie
        assert ADMIN not in cookie
        assert client.get(f"{server.address}/admin/admin.js").status_code == 200
        assert client.get(f"{server.address}/admin/api/progress").status_code == 200


@pytest.mark.parametrize(("host", "secure"), [("study.example.org", True), ("127.0.0.1", False)])
def test_the_cookie_stays_on_https_where_a_proxy_has_it(server, monkeypatch, host, secure):
    monkeypatch.setattr(server.service, "address", "https://study.example.org")
    with httpx.Client() as client:  # Of its own: it keeps the cookie.
        answer = client.get(
            f"{server.address}/admin/", params={"token": ADMIN}, headers={"Host": host}
        )
    assert ("; secure" in answer.headers["set-cookie"].lower()) is secure


def test_invitations_are_links_that_work(server):
    said = {"role": "watcher", "count": 2}
    found = HTTP.post(f"{server.address}/admin/api/invite", json=said, headers=BEARER).json()
    assert len({link["link"] for link in found["links"]}) == 2
    for link in found["links"]:
        assert HTTP.get(link["link"]).status_code == 200
        assert link["link"] == server.address + link["path"]


def test_invitations_keep_an_external_id_and_who_is_a_script(server):
    said = {"role": "watcher", "external_id": "prolific-7", "kind": "scripted"}
    found = HTTP.post(f"{server.address}/admin/api/invite", json=said, headers=BEARER).json()
    person = server.service.store.participant(found["links"][0]["code"])
    assert (person.external_id, person.kind) == ("prolific-7", "scripted")


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ({"role": "king"}, "there is no such role: the study has novice, watcher, player"),
        ({"role": "watcher", "count": 0}, "count: Input should be greater than or equal to 1"),
        (
            {"role": "watcher", "count": 2, "external_id": "x"},
            "an external id belongs to one participant: count must be 1",
        ),
    ],
)
def test_a_wrong_invitation_is_explained(server, said, told):
    answer = HTTP.post(f"{server.address}/admin/api/invite", json=said, headers=BEARER)
    assert (answer.status_code, answer.json()["message"]) == (400, told)


def test_progress_shows_participants_pace_and_what_was_refused(server):
    page = server.page()
    with page.live() as live:
        live.episode()
        live.say(type="nonsense")
        live.hear()
        found = HTTP.get(f"{server.address}/admin/api/progress", headers=BEARER).json()
    (line,) = (one for one in found["participants"] if one["code"] == page.code)
    assert (line["episodes"], line["playing"], line["status"]) == (1, True, "active")
    assert found["since_start"]["period_ms"]["steps"] > 0
    assert found["refused"]["live:invalid"] >= 1


def test_an_export_is_a_zip_of_what_was_collected(server):
    page = server.page()
    with page.live() as live:
        live.episode()
    answer = HTTP.get(f"{server.address}/admin/api/export", headers=BEARER, timeout=30)
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as found:
        table = found.read("participants.csv").decode()
    assert page.code in table
    left = (server.service.data / "exports").iterdir()
    assert {path.name for path in left} == {"everything"}  # The .zip has no name, nor outlives us.
