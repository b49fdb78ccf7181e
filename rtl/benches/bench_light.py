"""voxrt_light: each lane's hit points become its shadow rays, in order; and where the light is among the planes."""

import random

import cocotb
from bench_brightness import lit_point, some_place
from cocotb.triggers import ClockCycles, RisingEdge
from streams import drive, pace, reset, start
from structs import HIT_POINT, LIGHT_PLANES, SCAN, SHADOW_POINT, SHADOW_RAY, packed_array, signed

LANES, DEPTH, QUEUE = 3, 6, 16


class Lanes:
    """The lanes around it: they ask while they may, and start what comes at their own pace."""

    def __init__(self, dut, asking, starting):
        self.dut = dut
        self.asks, self.starts = pace(asking), pace(starting)
        self.claimed = [0] * LANES
        self.wanted = [[] for _ in range(LANES)]
        self.waiting = [0] * LANES
        self.credits = [QUEUE] * LANES

    async def run(self, clocks, *, ask=True):
        dut, side, light = self.dut, self.side, self.light
        for _ in range(clocks):
            claims = [ask and self.credits[lane] > 0 and next(self.asks) for lane in range(LANES)]
            gives = [self.claimed[lane] > 0 and random.random() < 0.5 for lane in range(LANES)]
            starts = [self.waiting[lane] > 0 and next(self.starts) for lane in range(LANES)]
            drive(dut, hit_point_claim_i=sum(bool(bit) << lane for lane, bit in enumerate(claims)))
            drive(dut, hit_point_valid_i=sum(bool(bit) << lane for lane, bit in enumerate(gives)))
            drive(dut, issued_i=sum(bool(bit) << lane for lane, bit in enumerate(starts)))
            for lane in range(LANES):
                face, mirrored, tag = random.randrange(3), random.randrange(8), random.randrange(256)
                place = some_place(side, face)
                dut.hit_point_i[lane].value = HIT_POINT.pack(tag=tag, face=face, mirrored=mirrored, point=place)
                if gives[lane]:
                    point = lit_point(place, mirrored, face, side)
                    direction = [2 * at - own for at, own in zip(light, point, strict=True)]
                    self.wanted[lane].append((tag, point, direction))
            await RisingEdge(dut.clk_i)
            ready = dut.hit_point_ready_o.value.to_unsigned()
            assert ready == sum((count > 0) << lane for lane, count in enumerate(self.credits))
            for lane in range(LANES):
                self.credits[lane] += bool(starts[lane]) - bool(claims[lane])
                self.claimed[lane] += bool(claims[lane]) - bool(gives[lane])
                self.waiting[lane] -= bool(starts[lane])
            if int(dut.valid_o.value):
                lane = dut.lane_o.value.to_unsigned().bit_length() - 1
                assert dut.lane_o.value.to_unsigned() == 1 << lane
                ray = SHADOW_RAY.unpack(dut.shadow_ray_o)
                point = [signed(value, SHADOW_POINT) for value in ray["point"]]
                direction = [signed(value, SCAN) for value in ray["direction"]]
                assert (ray["tag"], point, direction) == self.wanted[lane].pop(0)
                self.waiting[lane] += 1

    def frame(self):
        self.side = 1 << random.randint(1, DEPTH)
        reach = random.choice([16 * self.side, (1 << 20) - 1])
        self.light = [random.choice([0, 16 * random.randint(-2, 70), random.randint(-reach, reach)]) for _ in range(3)]
        drive(self.dut, side_i=self.side, light_i=packed_array(self.light, 32))

    def check_planes(self):
        """Compare the numbers of planes before the light, and not behind it."""
        planes = LIGHT_PLANES.unpack(self.dut.light_planes_o)
        for mirrored in range(2):
            for axis, own in enumerate(self.light):
                light = 16 * self.side - own if mirrored else own
                before = sum(16 * plane < light for plane in range(self.side))
                reached = sum(16 * plane <= light for plane in range(self.side))
                assert planes["occluder"][3 * mirrored + axis] == before
                assert planes["backface"][3 * mirrored + axis] == reached


@cocotb.test()
@cocotb.parametrize(asking=["always", "random"], starting=["always", "random"])
async def shadow_rays(dut, asking, starting):
    await start(dut, hit_point_claim_i=0, hit_point_valid_i=0, issued_i=0)
    lanes = Lanes(dut, asking, starting)
    for _ in range(10):
        lanes.frame()
        await ClockCycles(dut.clk_i, 3)
        lanes.check_planes()
        await lanes.run(80)
        await lanes.run(150, ask=False)
        assert not any(lanes.wanted)
        assert not any(lanes.claimed)


@cocotb.test()
async def reset_at_any_clock(dut):
    await start(dut, hit_point_claim_i=0, hit_point_valid_i=0, issued_i=0)
    for _ in range(10):
        lanes = Lanes(dut, "random", "random")
        lanes.frame()
        await ClockCycles(dut.clk_i, 3)
        await lanes.run(random.randrange(1, 60))
        drive(dut, hit_point_claim_i=0, hit_point_valid_i=0, issued_i=0)
        await reset(dut)
