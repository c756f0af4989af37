"""`rigid study serve`: the study as a page that one sends to participants."""

from __future__ import annotations

import secrets
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.naming import OpeningOptions
from rigid.commands.terminal.helping import several
from rigid.commands.terminal.stopping import goes_on
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.study.plan import StudyPlan
    from rigid.study.players import Players
    from rigid.study.store import Store

_shown_as = tyro.conf.arg
_KEYS = "abcdefghijklmnopqrstuvwxyz"


@dataclass(frozen=True, kw_only=True)
class ServeCommand(OpeningOptions):
    """Serve a study: participants play with the robot and judge motions in their browser.

    Prints the admin's link, from which participants are invited; without --study also the link of
    a first participant. Everything is kept in --data: the same command goes on where it was
    stopped, and links stay good. Plain HTTP unless --tls-cert is given, which VR headsets need.

    Examples:
      rigid study serve --task itch-scratching --robot builtin:vanilla --data studies/first
      rigid study serve --study study.yaml --data studies/second --host 0.0.0.0 --tls-cert cert.pem
    """

    data: Path
    """Directory of what the study collects; made if it is new."""
    study: Annotated[str | None, _shown_as(metavar="FILE.yaml")] = None
    """What the study is (docs/study.md), or builtin:NAME; by default novices who watch, practise
    and play."""
    task: str | None = None
    """Task to play, in place of the study's; itch-scratching without a study."""
    robot: Annotated[tuple[str, ...], several("ROBOT…")] = ()
    """Robots to meet, in place of the study's; builtin:vanilla without a study."""
    host: str = "127.0.0.1"
    """Address to listen on; 0.0.0.0 for all of this machine's."""
    port: int = 8000
    """Port to listen on; 0 for any that is free."""
    url: Annotated[str | None, _shown_as(metavar="URL")] = None
    """How participants reach the server, where that is not host and port; links begin with it."""
    tls_cert: Annotated[Path | None, _shown_as(metavar="FILE.pem")] = None
    """Certificate (with its chain), for HTTPS."""
    tls_key: Annotated[Path | None, _shown_as(metavar="FILE.pem")] = None
    """Its private key, if not in the same file."""
    admin_token_file: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Holds the admin's token; by default one is drawn, printed once, and only its hash is kept."""

    def run(self) -> int:
        """Serves until it is stopped."""
        from rigid.study.service.opening import open_service
        from rigid.study.service.running import address_of_server, check_tls, listen, serve
        from rigid.study.store import Store

        check_tls(self.tls_cert, self.tls_key)
        plan, url, token = self._plan(), _checked(self.url), self._given_token()
        tls = self.tls_cert is not None
        with listen(self.host, self.port) as opened:
            task, robots = self._players(plan)
            with Store.open(self.data, plan) as store:
                address = url or address_of_server(opened, self.host, tls=tls)
                service = open_service(
                    store, plan, task, robots, data=self.data, address=address, say=_say
                )
                self._print_links(store, plan, address, token)
                with goes_on(self.data, lambda: True):
                    serve(service, opened, certificate=self.tls_cert, key=self.tls_key)
        return 0

    def _plan(self) -> StudyPlan:
        """The study: of the file, else as it was begun, else a new one."""
        from rigid.study.plan import default_plan, load_plan

        kept = None if self.study else _kept_plan(self.data)
        if self.study or kept:
            plan = load_plan(self.study) if self.study else kept
            assert plan is not None
            return self._overridden(plan)
        return default_plan(self.task or "itch-scratching", _by_key(self.robot))

    def _overridden(self, plan: StudyPlan) -> StudyPlan:
        """The plan with the task and the robots of the command line."""
        changes: dict[str, object] = {} if self.task is None else {"task": self.task}
        if self.robot:
            if len(self.robot) != len(plan.robots):
                raise UserError(
                    f"--robot names {len(self.robot)} robots, but the study has "
                    f"{len(plan.robots)} ({', '.join(plan.robots)}): name as many"
                )
            changes["robots"] = dict(zip(plan.robots, self.robot, strict=True))
        return plan.model_copy(update=changes)

    def _players(self, plan: StudyPlan) -> Players:
        """What the command line names is trusted as anywhere; what a file names is not."""
        from rigid.study.players import open_players

        opening = replace(self.opening(), named_by_user=bool(self.robot) or self.trust)
        return open_players(plan, trust=self.trust or bool(self.task), opening=opening)

    def _print_links(self, store: Store, plan: StudyPlan, address: str, given: str | None) -> None:
        """The only moment at which tokens are seen."""
        lines = [f"{plan.title} ({plan.task}): {address}"]
        drawn = None if given or store.has_admin() else secrets.token_urlsafe(24)
        if given or drawn:
            store.set_admin_token(given or drawn or "")
        if drawn:
            lines.append(f"admin token: {drawn}")
            lines.append(f"admin page: {address}/admin/?token={drawn}")
        else:
            whose = f"in {self.admin_token_file}" if given else "the one of the first start"
            lines.append(f"admin page: {address}/admin/?token=… (the token is {whose})")
        if self.study is None and not store.participants():
            role = next(iter(plan.roles))
            invited = store.invite(role)
            lines.append(f"participant {invited.code} ({role}): {address}/p/{invited.token}")
        lines.append(f"kept in {self.data}; stop with Ctrl-C, the same command goes on")
        print("\n".join(lines), flush=True)

    def _given_token(self) -> str | None:
        """The admin's token in a file of theirs."""
        from rigid.files import read_bytes

        if self.admin_token_file is None:
            return None
        cure = "write a token of 20 to 200 letters and digits into it"
        text = read_bytes(self.admin_token_file, cure=cure).decode("utf-8", "replace").strip()
        if not (20 <= len(text) <= 200 and text.replace("-", "").replace("_", "").isalnum()):
            raise UserError(f"{self.admin_token_file} holds no token: {cure}")
        return text


def _by_key(robots: tuple[str, ...]) -> dict[str, str]:
    """Robots of the command line under keys: a, b, c and so on."""
    if len(robots) > len(_KEYS):
        raise UserError(f"--robot names {len(robots)} robots; a study has at most {len(_KEYS)}")
    return dict(zip(_KEYS, robots or ("builtin:vanilla",), strict=False))


def _kept_plan(data: Path) -> StudyPlan | None:
    """The plan of a study that was begun in `data`."""
    from rigid.study.store import Store
    from rigid.study.store.schema import FILE

    if not (data / FILE).exists():
        return None
    with Store.read(data) as store:
        return store.plan()


def _checked(url: str | None) -> str | None:
    if url is not None and not url.startswith(("http://", "https://")):
        raise UserError(f"--url {url!r} is no address: write it as https://study.example.org")
    return None if url is None else url.rstrip("/")


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
