from voxrt.serve.admission import Bucket, Gate, is_loopback
from voxrt.serve.handover import IDLE_SECONDS, Handover


def test_one_steers_and_others_wait():
    now = [0.0]
    handover = Handover(lambda: now[0])
    assert handover.take(1)
    assert handover.take(1)
    assert not handover.take(2)
    assert not handover.take(3)
    assert not handover.take(2)
    assert handover.waiting == (2, 3)
    assert handover.use(1)
    assert not handover.use(2)
    handover.leave(1)
    assert (handover.controller, handover.waiting) == (2, (3,))
    handover.leave(3)
    handover.leave(2)
    assert (handover.controller, handover.waiting) == (None, ())


def test_the_idle_give_way():
    now = [0.0]
    handover = Handover(lambda: now[0])
    handover.take(1)
    now[0] = IDLE_SECONDS
    assert not handover.take(2)
    now[0] = IDLE_SECONDS + 1
    assert handover.take(2)
    assert handover.controller == 2


def test_bucket():
    now = [0.0]
    bucket = Bucket(10, lambda: now[0])
    assert [bucket.take() for _ in range(20)] == [0.0] * 20
    wait = bucket.take()
    assert 0 < wait <= 0.1
    now[0] += wait
    assert bucket.take() == 0
    now[0] += 1000
    assert [bucket.take() > 0 for _ in range(21)] == [False] * 20 + [True]


def judged(gate, origin=None, target="/v1", authorization=None, address=("127.0.0.1", 80)):
    refusal = gate.judge(target, authorization, origin, address)
    return refusal and refusal.status


def test_origins():
    gate = Gate(None)
    assert judged(gate) is None
    assert judged(gate, "http://127.0.0.1") is None
    assert judged(gate, "http://localhost:80") is None
    for foreign in (
        "http://evil.example",
        "https://127.0.0.1",
        "http://127.0.0.1:81",
        "null",
        "",
        "http://[",
        "file://",
    ):
        assert judged(gate, foreign) == 403
    assert judged(gate, "http://localhost:8080", address=("127.0.0.1", 8080)) is None
    # A name that resolves here (DNS rebinding) is no address of ours, and loopback names need loopback.
    assert judged(gate, "http://evil.example:8080", address=("127.0.0.1", 8080)) == 403
    assert judged(gate, "http://localhost:8080", address=("192.0.2.7", 8080)) == 403
    assert judged(gate, "http://192.0.2.7:8080", address=("192.0.2.7", 8080)) is None
    assert judged(gate, "http://[2001:db8::7]:8080", address=("2001:db8::7", 8080)) is None
    assert judged(gate, "http://192.0.2.7:8080", address=("::ffff:192.0.2.7", 8080)) is None
    assert judged(Gate(None, ("http://pynq.local",)), "http://pynq.local") is None


def test_tokens():
    gate = Gate("sesame")
    assert judged(gate) == 401
    assert judged(gate, target="/v1?token=sesam") == 401
    assert judged(gate, target="/v1?token=%ff%00é") == 401
    assert judged(gate, target="/v1?token=sesame") is None
    assert judged(gate, authorization="Bearer sesame") is None
    assert judged(gate, authorization="Basic sesame") == 401


def test_loopback():
    for host in ("localhost", "127.0.0.1", "127.8.9.1", "::1", "::ffff:127.0.0.1"):
        assert is_loopback(host)
    for host in ("0.0.0.0", "::", "192.0.2.1", "localhost.example", ""):
        assert not is_loopback(host)
