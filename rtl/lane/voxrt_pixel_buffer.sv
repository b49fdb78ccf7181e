// Reorder buffer of a lane's pixels. Rays of a lane end in any order, but voxrt_merge wants pixels in order: an entry
// is allocated when a ray is issued, completed when the pixel is known, and read in order of allocation.
//
// Entries are in block RAM, read ahead of time, in order, two clocks long. An entry is complete when its phase bit is
// that of the reader; else it was read too early, and reading starts again from there. Nothing but the phase bits needs
// a reset, which takes Depth clocks.
//
// With StoresEarlier a pixel may be stored before its entry is completed, which then tells whether it is lit: two
// memories. Without, both happen at once, and one is enough.
`include "voxrt_assert.svh"

module voxrt_pixel_buffer #(
  parameter int unsigned Width         = 10,   // Bits: 1 or more.
  parameter int unsigned Depth         = 256,  // Entries: a power of two, 4 or more.
  parameter bit          StoresEarlier = 1'b0
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  // Allocate an entry. A tag is its index and, above it, its phase.
  input  logic                   allocate_i,  // Only with ready_o.
  output logic                   ready_o,
  output logic [$clog2(Depth):0] tag_o,
  // Complete an entry that was allocated, once, in any order.
  input  logic                   complete_i,
  input  logic [$clog2(Depth):0] tag_i,
  input  logic                   lit_i,
  // Store its pixel, once, no later than that.
  input  logic                   store_i,
  input  logic [      Width-1:0] pixel_i,
  // Pixels in order of allocation.
  output logic                   valid_o,
  input  logic                   ready_i,
  output logic                   lit_o,
  output logic [      Width-1:0] pixel_o
);
  if (Width < 1) $error("voxrt_pixel_buffer: Width must be 1 bit or more");
  if (Depth < 4 || 2 ** $clog2(Depth) != Depth) $error("voxrt_pixel_buffer: Depth must be a power of two, 4 or more");

  localparam int unsigned IndexBits = $clog2(Depth);
  localparam int unsigned TagBits = IndexBits + 1;
  localparam int unsigned FifoDepth = 4;

  // All entries are cleared to phase 0; pixels start with phase 1.
  localparam logic [TagBits-1:0] First = {1'b1, IndexBits'(0)};

  logic [TagBits-1:0] allocate_q, fetch_q, read_q, free;
  logic ready_q, clearing_q, fetches, valid1_q, valid2_q, phase2, complete, early, pops, fifo_ready;
  logic [2:0] waiting_q;  // Pixels in the FIFO.
  logic [IndexBits-1:0] write_index;

  // ready_o is a clock late, and an entry may have been allocated since: so the last free one is not given away.
  assign free        = (read_q ^ First) - allocate_q;
  assign ready_o     = ready_q;
  assign tag_o       = allocate_q;
  assign write_index = clearing_q ? allocate_q[IndexBits-1:0] : tag_i[IndexBits-1:0];

  // Two entries may be on their way when the FIFO fills up.
  assign fetches     = 3'(valid1_q) + 3'(valid2_q) + waiting_q < 3'(FifoDepth);
  assign complete    = valid2_q && phase2 == read_q[IndexBits];
  assign early       = valid2_q && !complete;
  assign pops        = valid_o && ready_i;

  always_ff @(posedge clk_i) begin
    ready_q <= free > TagBits'(1) && !clearing_q && rst_ni;
    if (allocate_i || clearing_q) allocate_q <= allocate_q + 1'b1;
    if (allocate_q[IndexBits-1:0] == '1) clearing_q <= 1'b0;
    if (fetches) fetch_q <= fetch_q + 1'b1;
    if (complete) read_q <= read_q + 1'b1;
    valid1_q  <= fetches;
    valid2_q  <= valid1_q;
    waiting_q <= waiting_q + 3'(complete) - 3'(pops);
    if (early || clearing_q) begin
      fetch_q  <= read_q;
      valid1_q <= 1'b0;
      valid2_q <= 1'b0;
    end
    if (!rst_ni) begin
      allocate_q <= '0;
      fetch_q    <= First;
      read_q     <= First;
      clearing_q <= 1'b1;
      valid1_q   <= 1'b0;
      valid2_q   <= 1'b0;
      waiting_q  <= '0;
    end
  end

  if (StoresEarlier) begin : gen_two_memories
    typedef struct packed {
      logic phase;
      logic lit;
    } mark_t;

    (* ram_style = "block" *)
    mark_t mark_q[Depth];
    (* ram_style = "block" *)
    logic [Width-1:0] pixel_q[Depth];
    mark_t mark1_q, mark2_q;
    logic [Width-1:0] pixel1_q, pixel2_q;

    always_ff @(posedge clk_i) begin
      if (complete_i || clearing_q) mark_q[write_index] <= '{phase: !clearing_q && tag_i[IndexBits], lit: lit_i};
      if (store_i) pixel_q[tag_i[IndexBits-1:0]] <= pixel_i;
      mark1_q  <= mark_q[fetch_q[IndexBits-1:0]];
      mark2_q  <= mark1_q;
      pixel1_q <= pixel_q[fetch_q[IndexBits-1:0]];
      pixel2_q <= pixel1_q;
    end

    assign phase2 = mark2_q.phase;

    voxrt_fifo #(
      .Width(1 + Width),
      .Depth(FifoDepth)
    ) u_read (
      .clk_i,
      .rst_ni,
      .valid_i(complete),
      .ready_o(fifo_ready),
      .data_i ({mark2_q.lit, pixel2_q}),
      .valid_o,
      .ready_i,
      .data_o ({lit_o, pixel_o})
    );
  end else begin : gen_one_memory
    typedef struct packed {
      logic             phase;
      logic [Width-1:0] pixel;
    } entry_t;

    (* ram_style = "block" *)
    entry_t entry_q[Depth];
    entry_t entry1_q, entry2_q;
    logic unused_store;

    always_ff @(posedge clk_i) begin
      if (complete_i || clearing_q) entry_q[write_index] <= '{phase: !clearing_q && tag_i[IndexBits], pixel: pixel_i};
      entry1_q <= entry_q[fetch_q[IndexBits-1:0]];
      entry2_q <= entry1_q;
    end

    assign unused_store = store_i && lit_i;
    assign lit_o        = 1'b0;
    assign phase2       = entry2_q.phase;

    voxrt_fifo #(
      .Width(Width),
      .Depth(FifoDepth)
    ) u_read (
      .clk_i,
      .rst_ni,
      .valid_i(complete),
      .ready_o(fifo_ready),
      .data_i (entry2_q.pixel),
      .valid_o,
      .ready_i,
      .data_o (pixel_o)
    );
  end

  `VOXRT_ASSERT(AllocatedEntryWasFree, !allocate_i || ready_o)
  `VOXRT_ASSERT(FifoHoldsPixel, !complete || fifo_ready)
endmodule
