// The table: the boot list, lists of the host, the orbit. One port; a word comes two clocks after its address.
module board_table
  import board_pkg::*;
#(
  parameter string File = ""  // For $readmemh; "": empty.
) (
  input  logic                 clk_i,
  input  logic                 write_i,
  input  logic [TableBits-1:0] word_i,
  input  logic [         31:0] data_i,
  output logic [         31:0] data_o
);
  logic [31:0] data_q[2 ** TableBits]  /* verilator public_flat_rw */;
  logic [31:0] read_q;

  if (File != "") begin : gen_content
    initial $readmemh(File, data_q);
  end

  always_ff @(posedge clk_i) begin
    if (write_i) data_q[word_i] <= data_i;
    else read_q <= data_q[word_i];
    data_o <= read_q;
  end
endmodule
