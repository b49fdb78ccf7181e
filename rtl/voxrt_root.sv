// Where a frame's octree starts: the root word, from word 0, which stands in a register, or from anywhere else in the
// memory, by way of lane 0's read port, which has nothing to do before the frame.
//
// start_i takes the address and starts the search; done_o is high for one clock, with root_o from then on. An address
// beyond the memory gives a leaf with an error, as a bad pointer does.
module voxrt_root
  import voxrt_pkg::*;
#(
  parameter  int unsigned BlockBits    = 12,
  parameter  int unsigned MemoryClocks = 2,
  localparam int unsigned PayloadBits  = payload_bits(BlockBits)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 start_i,
  input  logic [         31:0] address_i,  // Of a word.
  input  logic [PayloadBits:0] first_i,    // Word 0.
  output logic                 done_o,
  output logic [PayloadBits:0] root_o,
  // Lane 0's port, as voxrt_octree_memory has it: an address while reads_o is high; what comes before done_o is not lane 0's.
  output logic                 reads_o,
  output logic [BlockBits-1:0] block_o,
  output logic [          2:0] octant_o,
  input  logic                 ack_i,
  input  logic [PayloadBits:0] word_i
);
  localparam int unsigned RowBits = BlockBits + 3;

  logic                    reads_q, done_q;
  logic [MemoryClocks-1:0] under_way_q;
  logic [         31:0] row;
  logic [  RowBits-1:0] row_q;
  logic [PayloadBits:0] root_q;

  assign row = address_i - 32'd1;

  always_ff @(posedge clk_i) begin
    done_q      <= 1'b0;
    reads_q     <= 1'b0;
    under_way_q <= {under_way_q[MemoryClocks-2:0], reads_q};
    if (under_way_q[MemoryClocks-1]) begin
      reads_q <= !ack_i;
      done_q  <= ack_i;
      root_q  <= word_i;
    end
    if (start_i) begin
      row_q   <= row[RowBits-1:0];
      reads_q <= address_i != '0 && row[31:RowBits] == '0;
      done_q  <= address_i == '0 || row[31:RowBits] != '0;
      root_q  <= address_i == '0 ? first_i : {1'b1, PayloadBits'(9'h100)};
    end
    if (!rst_ni) begin
      reads_q     <= 1'b0;
      done_q      <= 1'b0;
      under_way_q <= '0;
    end
  end

  assign done_o              = done_q;
  assign root_o              = root_q;
  assign reads_o             = reads_q;
  assign {block_o, octant_o} = row_q;
endmodule
