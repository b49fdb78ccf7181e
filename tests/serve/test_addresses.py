"""The addresses and names by which browsers reach this machine."""

import ipaddress
import socket

import pytest

from voxrt.board.errors import Refused
from voxrt.serve.addresses import accepted_hosts, is_wildcard, reachable_hosts
from voxrt.serve.token import choose_token


def test_one_address_stands_for_itself():
    for host in ("127.0.0.1", "::1", "192.0.2.1", "pynq.local"):
        assert reachable_hosts(host) == (host,)
        assert not is_wildcard(host)
    assert accepted_hosts("192.0.2.1") == ("192.0.2.1",)
    assert accepted_hosts("127.0.0.1") == ()


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
def test_all_addresses_are_those_that_browsers_can_use(host):
    found = reachable_hosts(host)
    assert found[-1] == "127.0.0.1"
    assert host not in found
    assert len(set(found)) == len(found)
    for name in found[:-1]:
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            assert name in {socket.gethostname().lower(), socket.getfqdn().lower()}
        else:
            assert not address.is_loopback
    assert f"{socket.gethostname().lower().partition('.')[0]}.local" in accepted_hosts(host)
    assert "127.0.0.1" not in accepted_hosts(host)


def test_tokens(tmp_path):
    file = tmp_path / "token"
    file.write_text("se&sa#me\nmore\n")
    assert choose_token("127.0.0.1", None, None) is None
    assert choose_token("127.0.0.1", "sesame", None) == "sesame"
    assert choose_token("127.0.0.1", None, file) == "se&sa#me"
    assert len(choose_token("0.0.0.0", None, None)) >= 20
    (tmp_path / "empty").write_text("\n")
    for token, named, problem in (
        ("", None, "the token has 0 characters"),
        ("a b", None, "printable ASCII without spaces"),
        ("x" * 201, None, "the token has 201 characters"),
        (None, tmp_path / "empty", "the token has 0 characters"),
        (None, tmp_path / "absent", "the token cannot be read"),
        ("a", file, "exclude each other"),
    ):
        with pytest.raises(Refused, match=problem):
            choose_token("0.0.0.0", token, named)
