// Types and constants that the modules of the board designs share.
//
// A parameter that a module hands on has the unit and the range that the module says and checks which uses it:
// voxrt_core, board_pll, board_line_buffer, board_requests, board_sdram, board_boot_copy.
package board_pkg;

  // An access to the address map (docs/ecp5_boards.md): a whole word.
  typedef struct packed {
    logic        write;
    logic [23:0] address;
    logic [31:0] data;
  } access_t;

  // 640 x 480 at 25 MHz, 800 x 525 with blanking.
  localparam int unsigned Columns = 640;
  localparam int unsigned Rows = 480;
  localparam int unsigned ColumnsTotal = 800;
  localparam int unsigned RowsTotal = 525;
  localparam int unsigned ColumnSyncBegin = 656;
  localparam int unsigned ColumnSyncEnd = 752;
  localparam int unsigned RowSyncBegin = 490;
  localparam int unsigned RowSyncEnd = 492;

  // What the pixel clock tells the system clock at the beginning of each row.
  typedef struct packed {
    logic [9:0] row;
    logic [8:0] line;      // The line that it shows, 0 in the blanking.
    logic       underrun;  // It shows an older line than it should, or none.
  } row_event_t;

  // What the system clock tells the pixel clock at each complete line, and when a frame starts.
  typedef struct packed {
    logic       parity;  // Changes with each frame.
    logic [8:0] lines;   // Complete lines of the frame.
  } line_event_t;

  // Words of the table.
  localparam int unsigned TableBits = 12;

  // What the player, the requests and the core tell the board's registers: one clock each.
  typedef struct packed {
    logic request_done;
    logic request_bad;
    logic write_refused;
  } count_events_t;

  // What goes to an SDRAM: board_sdram makes it, board_sdram_pins brings it out. Names are those of the chip's pins.
  typedef struct packed {
    logic        cke,   cs_n, ras_n, cas_n, we_n;
    logic [1:0]  ba;
    logic [12:0] a;
    logic [1:0]  dqm;
    logic        dq_oe;                            // The data are driven.
    logic [15:0] dq;
  } sdram_out_t;
endpackage
