"""An external memory on the core's AXI4 read ports, for benches. It checks AXI's rules on the way."""

from collections import deque

LINE, BEATS = 32, 4
OKAY, SLVERR, DECERR = 0, 2, 3


class AxiMemory:
    """Ports that read one memory; what each clock shows and drives goes through `ports`.

    A port has `seen()`, which gives arvalid, araddr and rready, and `drive(arready, rvalid, rdata, rresp)`.
    """

    def __init__(self, ports, chance, base):
        self.ports, self.chance, self.base = ports, chance, base
        self.words = []
        self.latency, self.jitter, self.stalls = 5, 0, 0.0
        self.response = OKAY  # The response to lines whose address comes from now on.
        self.silent = False
        self.now = 0
        self.lines = [deque() for _ in ports]
        self.driven = [(0, 0, 0, 0) for _ in ports]
        self.offered = [None for _ in ports]
        self.addresses = []
        self.under_way = 0

    def word(self, byte):
        """Give the word at a byte address: word 0 of the octree is at base + 28."""
        number = (byte - self.base) // 4 - 7
        return int(self.words[number]) if 0 <= number < len(self.words) else 0

    def drive(self):
        """Drive all ports for the clock that begins."""
        for number, port in enumerate(self.ports):
            lines = self.lines[number]
            valid = bool(lines) and lines[0][1] <= self.now and not self.silent
            # A beat that was offered stays offered.
            if valid and not (self.driven[number][1] and not self.taken[number]):
                valid = self.chance.random() >= self.stalls
            beat = (0, 0)
            if valid:
                address, _, done, response = lines[0]
                byte = address + 8 * done
                beat = (self.word(byte + 4) << 32 | self.word(byte), response)
            ready = not self.silent and self.chance.random() >= self.stalls
            self.driven[number] = (ready, valid, *beat)
            port.drive(*self.driven[number])
        self.taken = [False for _ in self.ports]

    taken = (False, False)

    def edge(self):
        """See what the core did at the clock's edge."""
        for number, port in enumerate(self.ports):
            arvalid, address, rready = port.seen()
            ready, valid, _, _ = self.driven[number]
            if self.offered[number] is not None:
                assert (arvalid, address) == (1, self.offered[number]), "an address changed before it was taken"
            self.offered[number] = address if arvalid and not ready else None
            lines = self.lines[number]
            if valid and rready:
                self.taken[number] = True
                lines[0][2] += 1
                if lines[0][2] == BEATS:
                    lines.popleft()
            if arvalid and ready:
                assert address % LINE == 0, "a burst that is not aligned to its line"
                wait = self.latency + (self.chance.randrange(self.jitter + 1) if self.jitter else 0)
                lines.append([address, self.now + wait, 0, self.response])
                self.addresses.append(address)
                assert len(lines) <= 16, "more than 16 bursts of a port are under way"
            self.under_way = max(self.under_way, sum(map(len, self.lines)))
        self.now += 1


class StructPort:
    """A port of structs: voxrt_pkg::axi_read_request_t and axi_read_response_t."""

    def __init__(self, request, response):
        self.request, self.response = request, response

    def seen(self):
        number = self.request.value.to_unsigned()
        return number >> 33, number >> 1 & 0xFFFFFFFF, number & 1

    def drive(self, arready, rvalid, rdata, rresp):
        self.response.value = int(arready) << 67 | int(rvalid) << 66 | rdata << 2 | rresp


class PinPort:
    """A port of the core's pins, m_axi0_* or m_axi1_*."""

    def __init__(self, dut, prefix):
        self.dut, self.prefix = dut, prefix

    def pin(self, name):
        return getattr(self.dut, f"{self.prefix}_{name}")

    def seen(self):
        """Give arvalid, araddr, rready; an address's other pins never change."""
        fixed = tuple(int(self.pin(name).value) for name in ("arlen", "arsize", "arburst"))
        assert fixed == (BEATS - 1, 3, 1)
        return tuple(int(self.pin(name).value) for name in ("arvalid", "araddr", "rready"))

    def drive(self, arready, rvalid, rdata, rresp):
        """Drive the response; all beats but the last of a burst have rlast low, which the core does not read."""
        self.pin("arready").value = int(arready)
        self.pin("rvalid").value = int(rvalid)
        self.pin("rdata").value = rdata
        self.pin("rresp").value = rresp
        self.pin("rlast").value = 0
