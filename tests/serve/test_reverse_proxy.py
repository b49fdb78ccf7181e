"""The manual's configuration of nginx, run by nginx: page, frames and uploads over TLS."""

from __future__ import annotations

import asyncio
import re
import shutil
import ssl
import subprocess
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import pytest
from fakes.blob import blob_of
from fakes.device import scene
from fakes.serving import serving
from fakes.sockets import free_port
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from voxrt.board.errors import Refused
from voxrt.serve.frame_client import open_client

MANUAL = Path(__file__).parents[2] / "docs" / "reverse-proxy.md"
TEMPORARY = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")

for program in ("nginx", "openssl"):
    if shutil.which(program, path="/usr/sbin:/usr/local/sbin:/usr/bin:/bin:/usr/local/bin") is None:
        pytest.skip(f"{program} is not installed: apt install {program}", allow_module_level=True)


def configuration(folder, port, behind):
    """The configuration of the manual, for ports and a certificate of this test."""
    site = re.search(r"```nginx\n(.*?)```", MANUAL.read_text(encoding="utf-8"), re.DOTALL)[1]
    for manual, here in (
        ("listen 443 ssl", f"listen 127.0.0.1:{port} ssl"),
        ("voxels.example.org", "localhost"),
        ("/etc/ssl/voxels.pem", str(folder / "certificate.pem")),
        ("/etc/ssl/voxels.key", str(folder / "key.pem")),
        ("127.0.0.1:8080", f"127.0.0.1:{behind}"),
    ):
        assert manual in site
        site = site.replace(manual, here)
    paths = "".join(f"{name}_temp_path {folder / name};\n" for name in TEMPORARY)
    return f"daemon off; master_process off; pid {folder}/pid; events {{}}\nhttp {{\n{paths}{site}}}\n"


@contextmanager
def proxied(folder, port, behind):
    """A running nginx."""
    command = (
        "openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=DNS:localhost"
    )
    files = ["-keyout", folder / "key.pem", "-out", folder / "certificate.pem"]
    subprocess.run([*command.split(), *files], check=True, capture_output=True)
    (folder / "nginx.conf").write_text(configuration(folder, port, behind))
    nginx = shutil.which("nginx", path="/usr/sbin:/usr/local/sbin:/usr/bin:/usr/local/bin")
    command = [nginx, "-p", folder, "-e", folder / "errors", "-c", folder / "nginx.conf"]
    with subprocess.Popen(command) as process:
        try:
            while (folder / "pid").exists() is False or not (folder / "pid").read_text():
                assert process.poll() is None, (folder / "errors").read_text()
            yield
        finally:
            process.terminate()


async def test_the_configuration_of_the_manual(tmp_path, monkeypatch):
    port = free_port()
    origin = f"https://localhost:{port}"
    (tmp_path / "token").write_text("sesame\n")
    (tmp_path / "proxy").mkdir()
    (tmp_path / "own.blob").write_bytes(blob_of(scene("own")))
    with (
        serving(tmp_path, "own.blob", "--token-file", "token", "--origin", origin) as server,
        proxied(tmp_path, port, server.port),
    ):
        monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "certificate.pem"))
        context = ssl.create_default_context()
        handlers = urllib.request.HTTPSHandler(context=context), urllib.request.ProxyHandler({})
        opener = urllib.request.build_opener(*handlers)
        with opener.open(f"{origin}/", timeout=60) as answer:
            assert b"<canvas" in answer.read()
        with pytest.raises(urllib.error.HTTPError) as refused:  # as the page asks
            opener.open(f"{origin}/v2", timeout=60)
        with refused.value as answer:
            assert b"the token is missing or wrong" in answer.read()
        async with open_client(f"{origin}/#token=sesame") as client:
            await client.next_frame()
            await client.take_control()
            await client.upload({"new.blob": blob_of(scene("new", blocks=2))}, lambda *_: None)
            assert (await client.next_frame()).frame.colour.shape == (480, 640, 3)
        address = f"wss://localhost:{port}/v2"
        async with connect(f"{address}?token=sesame", origin=origin, proxy=None):
            pass
        for target, sender, status in (("", origin, 401), ("?token=sesame", "https://evil.example", 403)):
            with pytest.raises(InvalidStatus, match=str(status)):
                await connect(f"{address}{target}", origin=sender, proxy=None)
        with pytest.raises(Refused, match="the token is missing or wrong"):
            async with open_client(f"{origin}/#token=other"):
                pass
        assert await asyncio.to_thread(server.interrupt) == 0
