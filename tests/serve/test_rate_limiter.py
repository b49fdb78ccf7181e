"""The rate limiter, with a clock of the test."""

from voxrt.serve.rate_limiter import RateLimiter


def test_rate_and_burst():
    now = [0.0]
    limiter = RateLimiter(10, lambda: now[0])
    assert limiter.rested
    assert [limiter.acquire() for _ in range(21)] == [True] * 20 + [False]
    assert not limiter.rested
    now[0] += 0.101
    assert [limiter.acquire() for _ in range(2)] == [True, False]
    now[0] += 1000
    assert limiter.rested
    assert [limiter.acquire() for _ in range(21)] == [True] * 20 + [False]


def test_events_that_have_happened_are_waited_for():
    now = [0.0]
    limiter = RateLimiter(10, lambda: now[0], burst=5)
    assert limiter.charge(5) == 0
    assert limiter.charge(30) == 3
    assert not limiter.acquire()
    now[0] += 3
    assert limiter.charge(0) == 0
