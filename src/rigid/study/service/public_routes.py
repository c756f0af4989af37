"""What everybody may see: the welcome page and the front end."""

from __future__ import annotations

import html
from collections.abc import Mapping
from string import Template
from typing import Any

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from rigid.study.service.context import Service
from rigid.study.service.refusing import Refusal
from rigid.study.service.requests import address_of, service_of

_TYPES = {"study.js": "text/javascript", "study.css": "text/css"}
_PAGE = Template("""<!doctype html>
<html lang="$language">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<link rel="stylesheet" href="/static/study.css">
</head>
<body>
<main class="plain">
<h1>$title</h1>
<p>$text</p>
</main>
</body>
</html>
""")
_WORDS = {
    "welcome": "Welcome. If you were invited to this study, please use your personal link.",
    "unknown_link": "This link is not known. Please ask whoever invited you for a new one.",
    "admin": "This page is for whoever runs the study. Please open the admin link that was printed"
    " when the study was served first. If it is lost, serve the study with a token of your own:"
    " --admin-token-file.",
}
"""Where the language's file does not have them."""


def public_routes() -> list[Route]:
    """The welcome page and the front end."""
    return [
        Route("/", _welcome, methods=["GET"]),
        Route("/static/{name}", _static, methods=["GET"]),
    ]


def plain_page(service: Service, text: str) -> str:
    """A page of one paragraph; `text` names it in the section `service` of the texts."""
    section = service.texts.get("service")
    words: Mapping[str, Any] = section if isinstance(section, Mapping) else {}
    return _PAGE.substitute(
        language=html.escape(service.plan.language),
        title=html.escape(service.plan.title),
        text=html.escape(str(words.get(text, _WORDS[text]))),
    )


async def _welcome(request: Request) -> Response:
    service = service_of(request)
    service.allow(service.rates.public, address_of(request))
    return Response(plain_page(service, "welcome"), media_type="text/html")


async def _static(request: Request) -> Response:
    service = service_of(request)
    service.allow(service.rates.public, address_of(request))
    name = request.path_params["name"]
    if name not in _TYPES:
        raise Refusal("not-found", "there is no such file")
    return Response(service.static[name], media_type=_TYPES[name])
