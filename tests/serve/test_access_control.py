"""Tokens and origins."""

from voxrt.serve.access_control import AccessControl, is_loopback


def status_of(access, origin=None, target="/v2", authorization=None, address=("127.0.0.1", 80)):
    refusal = access.check(target, authorization, origin, address)
    return refusal and refusal.status


def test_origins():
    access = AccessControl(None)
    assert status_of(access) is None
    assert status_of(access, "http://127.0.0.1") is None
    assert status_of(access, "http://localhost:80") is None
    for foreign in (
        "http://evil.example",
        "https://127.0.0.1",
        "http://127.0.0.1:81",
        "null",
        "",
        "http://[",
        "file://",
    ):
        assert status_of(access, foreign) == 403
    assert status_of(access, "http://localhost:8080", address=("127.0.0.1", 8080)) is None
    # A foreign name that resolves to this address (DNS rebinding) is refused; loopback names need loopback.
    assert status_of(access, "http://evil.example:8080", address=("127.0.0.1", 8080)) == 403
    assert status_of(access, "http://localhost:8080", address=("192.0.2.7", 8080)) == 403
    assert status_of(access, "http://192.0.2.7:8080", address=("192.0.2.7", 8080)) is None
    assert status_of(access, "http://[2001:db8::7]:8080", address=("2001:db8::7", 8080)) is None
    assert status_of(access, "http://192.0.2.7:8080", address=("::ffff:192.0.2.7", 8080)) is None
    assert status_of(AccessControl(None, ("http://pynq.local",)), "http://pynq.local") is None
    named = AccessControl(None, hosts=("pynq", "pynq.local"))
    assert status_of(named, "http://pynq.local", address=("192.0.2.7", 80)) is None
    assert status_of(named, "http://pynq", address=("127.0.0.1", 80)) is None
    assert status_of(named, "http://localhost", address=("127.0.0.1", 80)) is None
    assert status_of(named, "http://localhost", address=("192.0.2.7", 80)) == 403


def test_a_page_asks_why_it_is_refused_by_an_origin_in_the_query():
    access = AccessControl("sesame")
    assert status_of(access, target="/v2?token=sesame&origin=http%3A%2F%2F127.0.0.1") is None
    assert status_of(access, target="/v2?token=sesame&origin=http%3A%2F%2Fevil.example") == 403
    assert status_of(access, target="/v2?origin=http%3A%2F%2F127.0.0.1") == 401
    # It allows nothing: the header counts too.
    assert status_of(access, "http://evil.example", "/v2?token=sesame&origin=http%3A%2F%2F127.0.0.1") == 403


def test_tokens():
    access = AccessControl("sesame")
    assert status_of(access) == 401
    assert status_of(access, target="/v2?token=sesam") == 401
    assert status_of(access, target="/v2?token=%ff%00é") == 401
    assert status_of(access, target="/v2?token=sesame") is None
    assert status_of(access, authorization="Bearer sesame") is None
    assert status_of(access, authorization="Basic sesame") == 401


def test_loopback():
    for host in ("localhost", "127.0.0.1", "127.8.9.1", "::1", "::ffff:127.0.0.1"):
        assert is_loopback(host)
    for host in ("0.0.0.0", "::", "192.0.2.1", "localhost.example", ""):
        assert not is_loopback(host)
