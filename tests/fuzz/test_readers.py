"""Files damaged at random: every reader reads them or refuses them in one line. ``run.py`` does so for longer."""

import pytest
from fuzz.readers import READERS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st


@pytest.mark.parametrize("name", READERS)
def test_seeds_are_read(name, tmp_path):
    for seed in READERS[name].seeds:
        assert READERS[name].run(tmp_path, seed)


@st.composite
def damaged(draw, reader):
    """A seed with a few stretches replaced: by nothing, by other bytes, by a word of the format, by one of its own."""
    data = draw(st.sampled_from(reader.seeds))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(data)))
        stop = min(len(data), start + draw(st.sampled_from([0, 1, 1, 2, 4, 16, 1 << 20])))
        at = draw(st.integers(0, len(data)))
        patch = draw(st.sampled_from([b"", *reader.tokens, data[at : at + 12]]) | st.binary(max_size=4))
        data = data[:start] + patch + data[stop:]
    return data


@pytest.mark.parametrize("name", READERS)
def test_damaged_files(name, tmp_path):
    reader = READERS[name]

    @settings(max_examples=80, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
    @given(damaged(reader))
    def check(data):
        reader.run(tmp_path, data)

    check()
