"""Who may connect, from where, and what those are told who may not."""

from __future__ import annotations

import asyncio
import urllib.error
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from fakes.serving import serving
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from voxrt.cli.run import run as voxrt
from voxrt.serve.frame_client import open_client

_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))


def page(url):
    with _OPENER.open(url.partition("#")[0], timeout=60) as answer:
        return answer.read()


def refusal_of(url, **headers):
    """Status and text of the answer to a page that asks why it is refused."""
    try:
        with _OPENER.open(urllib.request.Request(url, headers=headers), timeout=60) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


async def status(url, token, origin):
    parts = urlsplit(url)
    try:
        async with connect(f"ws://{parts.netloc}/v2?token={token}", origin=origin, proxy=None):
            return 101
    except InvalidStatus as error:
        return error.response.status_code


async def test_every_printed_address_works(tmp_path):
    (tmp_path / "token").write_text("se&sa#me%\n")
    with serving(tmp_path, "--host", "0.0.0.0", "--token-file", "token") as server:
        assert b"se&sa" not in Path(f"/proc/{server.process.pid}/cmdline").read_bytes()  # noqa: ASYNC240 - made by Linux
        assert server.url == server.urls[0]
        assert not any("0.0.0.0" in url for url in server.urls)
        for url in server.urls:
            parts = urlsplit(url)
            assert parts.fragment == "token=se%26sa%23me%25"
            assert b"<canvas" in page(url)
            assert await status(url, "se%26sa%23me%25", f"http://{parts.netloc}") == 101
            async with open_client(url) as opened:
                assert opened.hello["protocol"] == 2
        address = f"http://{urlsplit(server.urls[-1]).netloc}/v2"
        assert await status(address, "wrong", None) == 401
        assert await status(address, "se%26sa%23me%25", "http://evil.example") == 403
        code, text = refusal_of(f"{address}?token=wrong")
        assert code == 401
        assert "the token is missing or wrong: open the address that the server printed" in text
        code, text = refusal_of(address, Host="evil.example")
        assert code == 403
        assert "pages of http://evil.example may not connect; start the server with --origin" in text
        assert await asyncio.to_thread(server.interrupt) == 0


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--token", ""], "the token has 0 characters"),
        (["--token", "two words"], "printable ASCII without spaces"),
        (["--token-file", "/nonexistent"], "the token cannot be read"),
        (["--token", "a", "--token-file", "b"], "--token and --token-file exclude each other"),
    ],
)
def test_tokens_that_are_none_are_refused(capsys, arguments, problem):
    assert voxrt(["serve", *arguments]) == 2
    assert problem in capsys.readouterr().err
