# The z1 configuration on a board with a Zynq: bitstream and hardware handoff.
#
#   vivado -mode batch -source rtl/vivado/build.tcl -tclargs BOARD [PART [BOARD_PART]]
#
# BOARD is pynq-z1, the default, or aup-zu3. PART is another part of the same family. BOARD_PART names the board's files in
# your Vivado, which set up the processor's DDR memory; without it, Vivado's defaults stay.
#
# NOT RUN, for neither board: written without Vivado at hand, from its documentation. The core that it instantiates is proven by simulation;
# this script is not. Pictures go by VDMA into the processor's memory, as in the original; HDMI is not part of it.
#
# Addresses: registers (2 KiB), octree memory (256 KiB: ranges are powers of two, and the root makes it a word more than
# 128 KiB), VDMA: see `offsets` below.

lassign $argv board part board_part
if {$board eq ""} {set board pynq-z1}
switch $board {
  pynq-z1 {
    if {$part eq ""} {set part xc7z020clg400-1}
    set processor processing_system7
    set settings {CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ 100 CONFIG.PCW_USE_S_AXI_HP0 1 CONFIG.PCW_USE_M_AXI_GP0 1}
    set automation {make_external "FIXED_IO, DDR"}
    lassign {M_AXI_GP0 S_AXI_HP0 FCLK_CLK0} master memory_port clock
    set offsets {core/s_axil 0x43C00000 4K memory/S_AXI 0x42000000 256K vdma/S_AXI_LITE 0x43000000 64K}
  }
  aup-zu3 {
    if {$part eq ""} {set part xczu3eg-sfvc784-2-e}
    set processor zynq_ultra_ps_e
    set settings {
      CONFIG.PSU__CRL_APB__PL0_REF_CTRL__FREQMHZ 100
      CONFIG.PSU__USE__S_AXI_GP2 1
      CONFIG.PSU__USE__M_AXI_GP0 1
      CONFIG.PSU__USE__M_AXI_GP1 0
    }
    set automation [list apply_board_preset [expr {$board_part ne ""}]]
    lassign {M_AXI_HPM0_FPD S_AXI_HP0_FPD pl_clk0} master memory_port clock
    set offsets {core/s_axil 0xA3C00000 4K memory/S_AXI 0xA2000000 256K vdma/S_AXI_LITE 0xA3000000 64K}
  }
  default {error "there is no board $board: name pynq-z1 or aup-zu3"}
}

set here [file dirname [file normalize [info script]]]
set rtl [file dirname $here]
set out [file join $here build]
create_project -force voxrt_z1 $out -part $part
if {$board_part ne ""} {set_property board_part $board_part [current_project]}

set generated [file join $rtl generated]
add_files [concat \
  [list $rtl/voxrt_pkg.sv $generated/voxrt_registers_pkg.sv $generated/voxrt_registers.sv] \
  [lsearch -all -inline -not [glob $rtl/voxrt_*.sv] */voxrt_pkg.sv] \
  [list $here/voxrt_pynq_z1.v]]
update_compile_order -fileset sources_1

create_bd_design system
create_bd_cell -type ip -vlnv xilinx.com:ip:$processor ps
apply_bd_automation -rule xilinx.com:bd_rule:$processor -config $automation [get_bd_cells ps]
set_property -dict $settings [get_bd_cells ps]

create_bd_cell -type module -reference voxrt_pynq_z1 core
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_bram_ctrl memory
set_property -dict [list CONFIG.SINGLE_PORT_BRAM 1 CONFIG.READ_LATENCY 3 CONFIG.PROTOCOL AXI4] [get_bd_cells memory]
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma vdma
set_property -dict [list \
  CONFIG.c_include_mm2s 0 \
  CONFIG.c_include_s2mm 1 \
  CONFIG.c_s_axis_s2mm_tdata_width 32 \
  CONFIG.c_m_axi_s2mm_data_width 64 \
  CONFIG.c_use_s2mm_fsync 2 \
  CONFIG.c_num_fstores 3] [get_bd_cells vdma]

foreach slave {core/s_axil memory/S_AXI vdma/S_AXI_LITE} {
  apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config "Master /ps/$master Clk Auto" [get_bd_intf_pins $slave]
}
apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config {Master /vdma/M_AXI_S2MM Clk Auto} [get_bd_intf_pins ps/$memory_port]
connect_bd_intf_net [get_bd_intf_pins memory/BRAM_PORTA] [get_bd_intf_pins core/bram]
connect_bd_intf_net [get_bd_intf_pins core/m_axis] [get_bd_intf_pins vdma/S_AXIS_S2MM]
connect_bd_net [get_bd_pins ps/$clock] [get_bd_pins vdma/s_axis_s2mm_aclk]

foreach {segment offset range} $offsets {
  set mapped [get_bd_addr_segs -of_objects [get_bd_addr_spaces ps/Data] -filter "NAME =~ *[lindex [split $segment /] 0]*"]
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
write_hw_platform -fixed -include_bit -force $out/voxrt_z1.xsa
