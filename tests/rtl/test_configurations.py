"""The named configurations: one file, which says each default once."""

from __future__ import annotations

import json
import re

import pytest

from voxrt.rtl.configurations import RTL, ConfigurationError, read_configurations

DEFAULTS = {
    "Lanes": 1,
    "MaxDepth": 10,
    "PositionBits": 17,
    "BlockBits": 12,
    "MemoryForm": 0,
    "L1SetBits": 5,
    "L2SetBits": 9,
    "Light": 0,
    "Mirrors": 0,
    "RayClocks": 1,
    "Lod": 0,
    "SimulationBlockBits": 17,
}


@pytest.fixture
def read(tmp_path):
    def read(content):
        path = tmp_path / "configurations.json"
        path.write_text(json.dumps(content))
        return read_configurations(path)

    return read


def test_what_a_configuration_does_not_say_is_the_default(read):
    found = read({"defaults": DEFAULTS, "configurations": {"small": {}, "wide": {"Lanes": 3, "Light": 1}}})
    parameters = {name: value for name, value in DEFAULTS.items() if name != "SimulationBlockBits"}
    assert list(found) == ["small", "wide"]
    assert (found["small"].parameters, found["small"].simulation_block_bits) == (parameters, 17)
    assert found["wide"].parameters == parameters | {"Lanes": 3, "Light": 1}
    assert found["wide"].features == ("light",)
    assert found["wide"].words == 1 + 8 * 4096


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({"default": {}}, "configurations.json: key 'default' is not known; there are defaults, configurations"),
        (
            {"defaults": DEFAULTS | {"Lane": 2}, "configurations": {}},
            "configurations.json: defaults: key 'Lane' is not known; there are Lanes, ",
        ),
        (
            {"defaults": DEFAULTS, "configurations": {"wide": {"lanes": 2}}},
            "configurations.json: configurations: wide: key 'lanes' is not known; there are Lanes, ",
        ),
        (
            {"defaults": {"Lanes": 1}, "configurations": {}},
            "configurations.json: defaults: MaxDepth is missing; give it a whole number",
        ),
        (
            {"defaults": DEFAULTS, "configurations": {"wide": {"Lanes": "2"}}},
            "configurations.json: configurations: wide: Lanes is '2'; write a whole number",
        ),
    ],
)
def test_what_is_not_known_is_refused(read, content, message):
    with pytest.raises(ConfigurationError) as refused:
        read(content)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


def test_the_defaults_are_those_of_the_core():
    source = (RTL / "voxrt_core.sv").read_text()
    declared = re.findall(r"parameter (?:int unsigned|bit) +(\w+) += (?:1'b)?(\d+)", source)
    defaults = json.loads((RTL / "configurations.json").read_text())["defaults"]
    del defaults["SimulationBlockBits"]
    defaults["EndsFrames"] = 0  # no configuration sets it
    assert {name: int(value) for name, value in declared} == defaults


def test_the_simulation_was_built_of_the_same():
    rtl = pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")
    configurations = read_configurations()
    assert set(rtl.CONFIGS) == set(configurations)
    assert {name: set(each.features) for name, each in configurations.items()} == {
        name: set(features) for name, features in rtl.FEATURES.items()
    }
