# The z1 configuration on a PYNQ-Z1: bitstream and hardware handoff.
#
#   vivado -mode batch -source rtl/vivado/build.tcl
#
# NOT RUN: written without Vivado at hand, from its documentation. The core that it instantiates is proven by simulation;
# this script is not. Pictures go by VDMA into the processor's memory, as in the original; HDMI is not part of it.
#
# Addresses: 0x43C0_0000 registers (2 KiB), 0x4200_0000 octree memory (256 KiB: ranges are powers of
# two, and the root makes it a word more than 128 KiB), 0x4300_0000 VDMA.

set here [file dirname [file normalize [info script]]]
set rtl [file dirname $here]
set out [file join $here build]
create_project -force voxrt_z1 $out -part xc7z020clg400-1

set generated [file join $rtl generated]
add_files [concat \
  [list $rtl/voxrt_pkg.sv $generated/voxrt_registers_pkg.sv $generated/voxrt_registers.sv] \
  [lsearch -all -inline -not [glob $rtl/voxrt_*.sv] */voxrt_pkg.sv] \
  [list $here/voxrt_pynq_z1.v]]
update_compile_order -fileset sources_1

create_bd_design system
create_bd_cell -type ip -vlnv xilinx.com:ip:processing_system7 ps
apply_bd_automation -rule xilinx.com:bd_rule:processing_system7 -config {make_external "FIXED_IO, DDR"} [get_bd_cells ps]
set_property -dict [list \
  CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ 100 \
  CONFIG.PCW_USE_S_AXI_HP0 1 \
  CONFIG.PCW_USE_M_AXI_GP0 1] [get_bd_cells ps]

create_bd_cell -type module -reference voxrt_pynq_z1 core
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_bram_ctrl memory
set_property -dict [list CONFIG.SINGLE_PORT_BRAM 1 CONFIG.READ_LATENCY 2 CONFIG.PROTOCOL AXI4] [get_bd_cells memory]
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma vdma
set_property -dict [list \
  CONFIG.c_include_mm2s 0 \
  CONFIG.c_include_s2mm 1 \
  CONFIG.c_s_axis_s2mm_tdata_width 32 \
  CONFIG.c_m_axi_s2mm_data_width 64 \
  CONFIG.c_use_s2mm_fsync 2 \
  CONFIG.c_num_fstores 3] [get_bd_cells vdma]

foreach slave {core/s_axil memory/S_AXI vdma/S_AXI_LITE} {
  apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config {Master /ps/M_AXI_GP0 Clk Auto} [get_bd_intf_pins $slave]
}
apply_bd_automation -rule xilinx.com:bd_rule:axi4 -config {Master /vdma/M_AXI_S2MM Clk Auto} [get_bd_intf_pins ps/S_AXI_HP0]
connect_bd_intf_net [get_bd_intf_pins memory/BRAM_PORTA] [get_bd_intf_pins core/bram]
connect_bd_intf_net [get_bd_intf_pins core/m_axis] [get_bd_intf_pins vdma/S_AXIS_S2MM]
connect_bd_net [get_bd_pins ps/FCLK_CLK0] [get_bd_pins vdma/s_axis_s2mm_aclk]

foreach {segment offset range} {
  core/s_axil 0x43C00000 4K
  memory/S_AXI 0x42000000 256K
  vdma/S_AXI_LITE 0x43000000 64K
} {
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
