// Sources of the self-test for a GW2A, in the order in which tools must read them. It has no ray tracer.
board_pkg.sv
gowin_cells.sv
board_synchronizer.sv
board_event.sv
board_clock_meter.sv
gowin_clocks.sv
board_reset.sv
board_tmds.sv
board_screen.sv
gowin_serializer.sv
board_bars.sv
board_crc32.sv
board_uart.sv
board_requests.sv
board_selftest.sv
gowin_selftest.sv
