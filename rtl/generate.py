"""Make what registers.rdl describes: ``python rtl/generate.py``. Needs the package peakrdl; what it makes is committed.

The AXI4-Lite block, the C header and the IP-XACT are PeakRDL's own. The Python map and the manual's table are written
here from the model that its compiler gives.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from systemrdl import RDLCompiler
from systemrdl.node import AddrmapNode, MemNode, RegNode

RTL = Path(__file__).resolve().parent
SOURCE = RTL / "registers.rdl"
GENERATED = RTL / "generated"


def peakrdl(*arguments: str | Path) -> None:
    subprocess.run([sys.executable, "-m", "peakrdl", *arguments], check=True)


def register_decode(text: str) -> str:
    """Put a register behind the address decode of PeakRDL's block, which would be the longest path of a small core.

    The decode becomes `decode_*`, and what it gives takes effect a clock later, as `decoded_*`. A request waits while
    one is between the two, so that the order of answers does not change.
    """
    begin, end = text.index("    decoded_reg_strb_t decoded_reg_strb;"), text.index("    // Field logic")
    part = text[begin:end]
    signals = re.findall(r"^ +(decoded_reg_strb_t|logic(?: \[\d+:0\])?) (decoded_\w+);$", part, re.MULTILINE)
    clocked = ["decoded_reg_strb", "decoded_err", "decoded_req_is_external", "decoded_addr", "decoded_req"]
    clocked += ["decoded_req_is_wr", "decoded_wr_data", "decoded_wr_biten"]
    if [name for _, name in signals] != clocked:
        raise ValueError(f"PeakRDL's block has another decode: {signals}; look at register_decode")
    declarations = "".join(f"    {kind} {name.replace('decoded', 'decode', 1)};\n" for kind, name in signals)
    # The external memory's requests are followed where they take effect.
    pending_begin, pending_end = part.index("    logic external_wr_ack;"), part.index("    // Pass down signals")
    pending = part[pending_begin:pending_end]
    decode = re.sub(r"\bdecoded_", "decode_", part[part.index("    always_comb begin") : pending_begin])
    passed = re.sub(r"\bdecoded_", "decode_", part[pending_end:])
    passed_end = passed.index("    //----")
    registers = ["    always_ff @(posedge clk) begin", "        if(~rst_n) begin"]
    registers += [f"            {name} <= '0;" for name in ("decoded_req", "decoded_req_is_external", "decoded_err")]
    registers += ["            decoded_reg_strb <= '{default: '0};", "        end else begin"]
    registers += [f"            {name} <= decode_{name[8:]};" for name in clocked[:3] + clocked[4:5]]
    registers += ["        end"]
    registers += [f"        {name} <= decode_{name[8:]};" for name in clocked if name not in clocked[:3] + clocked[4:5]]
    registers += ["    end", ""]
    kept = part[: part.index("    always_comb begin")]
    joined = kept + declarations + "\n" + decode + pending + passed[:passed_end]
    joined += "\n    // A clock for the wires from the decode to all registers.\n" + "\n".join(registers)
    text = text[:begin] + joined + passed[passed_end:] + text[end:]
    for kind in ("rd", "wr"):
        stall = re.search(rf"    assign cpuif_req_stall_{kind} = (.*);\n", text)
        if stall is None:
            raise ValueError("PeakRDL's block stalls in another way; look at register_decode")
        text = text.replace(stall[0], f"    assign cpuif_req_stall_{kind} = {stall[1]} | decoded_req;\n")
    # It is used before the decode.
    text = text.replace("    logic decoded_req;\n", "", 1)
    return text.replace("    logic external_pending;\n", "    logic external_pending;\n    logic decoded_req;\n", 1)


def write_ip_xact(top: AddrmapNode) -> None:
    """Make the IP-XACT: PeakRDL's, and the material table, which it leaves out, as a block of its own.

    The version is that of the registers: major and minor of the register `version`.
    """
    version = ".".join(str(top.find_by_path(f"version.{name}").get_property("reset")) for name in ("major", "minor"))
    file = GENERATED / "voxrt_registers.xml"
    library = ("--vendor", "voxrt", "--library", "voxrt", "--version", version, "--standard", "2014")
    peakrdl("ip-xact", SOURCE, "-o", file, *library)
    materials = top.find_by_path("materials")
    start, size = materials.absolute_address, materials.size
    text, end = file.read_text(), "      </ipxact:addressBlock>\n"
    whole = f"<ipxact:range>'h{start + size:x}</ipxact:range>"
    last = max(node.absolute_address for node in top.children(unroll=True))
    if text.count(end) != 1 or text.count(whole) != 1 or last != start:
        raise ValueError("PeakRDL writes other IP-XACT, or the material table is not the last; look at write_ip_xact")
    block = f"""\
      <ipxact:addressBlock>
        <ipxact:name>materials</ipxact:name>
        <ipxact:displayName>{materials.get_property("name")}</ipxact:displayName>
        <ipxact:description>{" ".join(materials.get_property("desc").split())}</ipxact:description>
        <ipxact:baseAddress>'h{start:x}</ipxact:baseAddress>
        <ipxact:range>'h{size:x}</ipxact:range>
        <ipxact:width>32</ipxact:width>
        <ipxact:usage>memory</ipxact:usage>
        <ipxact:access>{"write-only" if materials.get_property("sw").name == "w" else "read-write"}</ipxact:access>
"""
    text = text.replace(whole, f"<ipxact:range>'h{start:x}</ipxact:range>")
    file.write_text(text.replace(end, end + block + end))


def main() -> None:
    GENERATED.mkdir(exist_ok=True)
    flags = [
        "--cpuif",
        "axi4-lite-flat",
        "--default-reset",
        "rst_n",
        "--rt-read-fanin",
        "--rt-read-response",
        "--err-if-bad-addr",
    ]
    peakrdl("regblock", SOURCE, "-o", GENERATED, *flags)
    block = GENERATED / "voxrt_registers.sv"
    block.write_text(register_decode(block.read_text()))
    peakrdl("c-header", SOURCE, "-o", GENERATED / "voxrt_registers.h")

    compiler = RDLCompiler()
    compiler.compile_file(str(SOURCE))
    top = compiler.elaborate().top
    write_ip_xact(top)
    python = [
        '"""Registers of the ray tracer, made of rtl/registers.rdl: name, byte address, fields as (low, width)."""',
        "",
        "REGISTERS = {",
    ]
    manual = ["# Registers", "", " ".join((top.get_property("desc") or "").split()), ""]
    for node in top.children(unroll=True):
        name = node.get_path_segment()
        description = " ".join((node.get_property("desc") or "").split())
        if isinstance(node, RegNode):
            fields = list(node.fields())
            python += [f'    "{name}": (', f"        0x{node.absolute_address:03X},", "        {"]
            python += [f'            "{field.inst_name}": ({field.low}, {field.width}),' for field in fields]
            python += ["        },", "    ),"]
            manual += [f"## 0x{node.absolute_address:03X} {name}", "", description, ""]
            manual += ["| bits | field | access | reset | |", "|---|---|---|---|---|"]
            for field in fields:
                bits = f"{field.high}:{field.low}" if field.width > 1 else f"{field.low}"
                access = "w1c" if field.get_property("onwrite") is not None else field.get_property("sw").name
                reset = field.get_property("reset")
                meaning = " ".join((field.get_property("desc") or "").split())
                manual.append(
                    f"| {bits} | {field.inst_name} | {access} | {'' if reset is None else reset} | {meaning} |"
                )
            manual.append("")
        elif isinstance(node, MemNode):
            manual += [f"## 0x{node.absolute_address:03X} {name}, {node.get_property('mementries')} words", ""]
            manual += [description, ""]
    python += ["}", f"MATERIALS = 0x{top.find_by_path('materials').absolute_address:03X}", ""]
    (GENERATED / "voxrt_registers.py").write_text("\n".join(python))
    (GENERATED / "registers.md").write_text("\n".join(manual))


if __name__ == "__main__":
    main()
