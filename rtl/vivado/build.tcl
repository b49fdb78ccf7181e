# The ray tracer on a board with a Zynq: bitstream and hardware handoff.
#
#   vivado -mode batch -source rtl/vivado/build.tcl -tclargs [BOARD [CONFIGURATION [PART [BOARD_PART]]]]
#
# BOARD is pynq-z1, the default, or aup-zu3. CONFIGURATION says where octrees are: z1, the default, has them in block
# RAM; cached1, cached4, cached8 and cached16 have them in the processor's DDR memory. PART is another part of the same
# family. BOARD_PART names the board's files in your Vivado, which set up the DDR memory; without it, Vivado's defaults
# stay.
#
# NOT RUN, for no board and no configuration: written without Vivado at hand, from its documentation. The core and its
# wrapper are simulated and tested; this script is not. Pictures go by VDMA into the processor's memory, as in the
# original; HDMI is not part of it.
#
# Addresses: registers (2 KiB), octree memory in block RAM (256 KiB: ranges are powers of two, and the root makes it a
# word more than 128 KiB), VDMA: see `offsets` below.
#
# Ports to the DDR memory, of 64 bits: HP0 for the VDMA, HP1 and HP3 for a cached core, so that its two ports end at
# different ports of the DDR controller. Its bursts of 4 beats with one id suit AXI3, which a Zynq-7000 has there;
# Vivado puts a converter before it. cached16 is too large for the PYNQ-Z1: bench/results/area.md.

lassign $argv board configuration part board_part
if {$board eq ""} {set board pynq-z1}
if {$configuration eq ""} {set configuration z1}
if {$configuration eq "z1"} {
  set wrapper voxrt_pynq_z1
} elseif {[regexp {^cached(1|4|8|16)$} $configuration - lanes]} {
  set wrapper voxrt_zynq_cached
} else {
  error "there is no configuration $configuration: name z1, cached1, cached4, cached8 or cached16"
}
set cached [expr {$configuration ne "z1"}]

switch $board {
  pynq-z1 {
    if {$part eq ""} {set part xc7z020clg400-1}
    set processor processing_system7
    set settings {CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ 100 CONFIG.PCW_USE_S_AXI_HP0 1 CONFIG.PCW_USE_M_AXI_GP0 1}
    if {$cached} {lappend settings CONFIG.PCW_USE_S_AXI_HP1 1 CONFIG.PCW_USE_S_AXI_HP3 1}
    set automation {make_external "FIXED_IO, DDR"}
    lassign {M_AXI_GP0 FCLK_CLK0} master clock
    lassign {S_AXI_HP0 S_AXI_HP1 S_AXI_HP3} video_port octree_port0 octree_port1
    set offsets {core/s_axil 0x43C00000 4K vdma/S_AXI_LITE 0x43000000 64K}
    if {!$cached} {lappend offsets memory/S_AXI 0x42000000 256K}
  }
  aup-zu3 {
    if {$part eq ""} {set part xczu3eg-sfvc784-2-e}
    set processor zynq_ultra_ps_e
    # Vivado counts the ports HP0 to HP3 as GP2 to GP5.
    set settings {
      CONFIG.PSU__CRL_APB__PL0_REF_CTRL__FREQMHZ 100
      CONFIG.PSU__USE__S_AXI_GP2 1
      CONFIG.PSU__USE__M_AXI_GP0 1
      CONFIG.PSU__USE__M_AXI_GP1 0
    }
    if {$cached} {
      lappend settings CONFIG.PSU__USE__S_AXI_GP3 1 CONFIG.PSU__SAXIGP3__DATA_WIDTH 64
      lappend settings CONFIG.PSU__USE__S_AXI_GP5 1 CONFIG.PSU__SAXIGP5__DATA_WIDTH 64
    }
    set automation [list apply_board_preset [expr {$board_part ne ""}]]
    lassign {M_AXI_HPM0_FPD pl_clk0} master clock
    lassign {S_AXI_HP0_FPD S_AXI_HP1_FPD S_AXI_HP3_FPD} video_port octree_port0 octree_port1
    set offsets {core/s_axil 0xA3C00000 4K vdma/S_AXI_LITE 0xA3000000 64K}
    if {!$cached} {lappend offsets memory/S_AXI 0xA2000000 256K}
  }
  default {error "there is no board $board: name pynq-z1 or aup-zu3"}
}

set here [file dirname [file normalize [info script]]]
set rtl [file dirname $here]
set out [file join $here build]
set name voxrt_$configuration
create_project -force $name $out -part $part
if {$board_part ne ""} {set_property board_part $board_part [current_project]}

set list [open $rtl/voxrt.f]
set sources [lsearch -all -inline [split [read $list] \n] *.sv]
close $list
add_files [concat [lmap source $sources {file join $rtl $source}] [list $here/$wrapper.v]]
set_property include_dirs $rtl [current_fileset]
update_compile_order -fileset sources_1

create_bd_design system
create_bd_cell -type ip -vlnv xilinx.com:ip:$processor ps
apply_bd_automation -rule xilinx.com:bd_rule:$processor -config $automation [get_bd_cells ps]
set_property -dict $settings [get_bd_cells ps]

create_bd_cell -type module -reference $wrapper core
if {$cached} {
  set_property CONFIG.Lanes $lanes [get_bd_cells core]
} else {
  create_bd_cell -type ip -vlnv xilinx.com:ip:axi_bram_ctrl memory
  set_property -dict [list CONFIG.SINGLE_PORT_BRAM 1 CONFIG.READ_LATENCY 3 CONFIG.PROTOCOL AXI4] [get_bd_cells memory]
}
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma vdma
set_property -dict [list \
  CONFIG.c_include_mm2s 0 \
  CONFIG.c_include_s2mm 1 \
  CONFIG.c_s_axis_s2mm_tdata_width 32 \
  CONFIG.c_m_axi_s2mm_data_width 64 \
  CONFIG.c_use_s2mm_fsync 2 \
  CONFIG.c_num_fstores 3] [get_bd_cells vdma]

# A slave's registers or memory, by a port of the processor.
foreach {slave - -} $offsets {
  apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config "Master /ps/$master Clk Auto" [get_bd_intf_pins $slave]
}
# A master's way to the DDR memory.
set ways [list vdma/M_AXI_S2MM $video_port]
if {$cached} {lappend ways core/m_axi0 $octree_port0 core/m_axi1 $octree_port1}
foreach {source port} $ways {
  apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config "Master /$source Clk Auto" [get_bd_intf_pins ps/$port]
}
if {!$cached} {connect_bd_intf_net [get_bd_intf_pins memory/BRAM_PORTA] [get_bd_intf_pins core/bram]}
connect_bd_intf_net [get_bd_intf_pins core/m_axis] [get_bd_intf_pins vdma/S_AXIS_S2MM]
connect_bd_net [get_bd_pins ps/$clock] [get_bd_pins vdma/s_axis_s2mm_aclk]

foreach {segment offset range} $offsets {
  set part_name [lindex [split $segment /] 0]
  set mapped [get_bd_addr_segs -of_objects [get_bd_addr_spaces ps/Data] -filter "NAME =~ *$part_name*"]
  set_property range $range $mapped
  set_property offset $offset $mapped
}
validate_bd_design
save_bd_design

make_wrapper -files [get_files system.bd] -top -import
set_property top system_wrapper [current_fileset]
launch_runs impl_1 -to_step write_bitstream -jobs 2
wait_on_run impl_1
open_run impl_1
report_utilization -file $out/utilization.txt
report_timing_summary -file $out/timing.txt
write_hw_platform -fixed -include_bit -force $out/$name.xsa
