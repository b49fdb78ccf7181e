"""The rate limiter, with a clock of the test."""

from voxrt.serve.rate_limiter import RateLimiter


def test_rate_and_burst():
    now = [0.0]
    limiter = RateLimiter(10, lambda: now[0])
    assert [limiter.acquire() for _ in range(20)] == [0.0] * 20
    delay = limiter.acquire()
    assert 0 < delay <= 0.1
    now[0] += delay
    assert limiter.acquire() == 0
    now[0] += 1000
    assert [limiter.acquire() > 0 for _ in range(21)] == [False] * 20 + [True]
