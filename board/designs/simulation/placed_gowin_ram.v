// A block RAM of the GW2A, without output registers: 1,024 rows of 18 bits, of which a port sees words of its width. What
// it holds at first comes from FILE; "": zeros. MODE: what a port that writes reads: 0 what it read before, 1 what it
// writes, 2 what was there.
module placed_gowin_ram #(
  parameter WIDTH_A = 18, parameter WIDTH_B = 18, parameter MODE_A = 0, parameter MODE_B = 0, parameter FILE = ""
) (
  input CLKA, input CEA, input WREA, input [13:0] ADA, input [35:0] DIA, output [35:0] DOA,
  input CLKB, input CEB, input WREB, input [13:0] ADB, input [35:0] DIB, output [35:0] DOB
);
  reg [17:0] rows [0:1023];
  reg [35:0] a_q, b_q;
  integer i;
  initial if (FILE != "") $readmemh(FILE, rows); else for (i = 0; i < 1024; i = i + 1) rows[i] = 18'd0;
  assign DOA = a_q;
  assign DOB = b_q;

  // Where the bits of an access are in a row, whether they are its own or of the two rows that a wide word has.
  function [4:0] place(input integer width, input [13:0] address);
    case (width)
      1: place = {1'b0, address[3:0]} + {4'd0, address[3]};
      2: place = {1'b0, address[3:1], 1'b0} + {4'd0, address[3]};
      4: place = {1'b0, address[3:2], 2'b00} + {4'd0, address[3]};
      8, 9: place = address[3] ? 5'd9 : 5'd0;
      default: place = 5'd0;
    endcase
  endfunction

  // Bits that an access of up to 18 bits writes.
  function [17:0] mask(input integer width, input [13:0] address);
    case (width)
      1, 2, 4, 8, 9: mask = 18'((1 << width) - 1) << place(width, address);
      16: mask = {1'b0, {8{address[1]}}, 1'b0, {8{address[0]}}};
      default: mask = {{9{address[1]}}, {9{address[0]}}};
    endcase
  endfunction

  function [17:0] spread(input [15:0] value);
    spread = {1'b0, value[15:8], 1'b0, value[7:0]};
  endfunction

  function [15:0] joined(input [17:0] row);
    joined = {row[16:9], row[7:0]};
  endfunction

  // A row as a port of a width reads and writes it.
  function [35:0] read(input integer width, input [13:0] address, input [17:0] row, input [17:0] next);
    case (width)
      16: read = {20'd0, joined(row)};
      18: read = {18'd0, row};
      32: read = {4'd0, joined(next), joined(row)};
      36: read = {next, row};
      default: read = {18'd0, (row >> place(width, address)) & 18'((1 << width) - 1)};
    endcase
  endfunction

  function [17:0] written(input integer width, input [13:0] address, input [35:0] value, input [17:0] row);
    written = (row & ~mask(width, address)) |
              ((width == 16 ? spread(value[15:0]) : value[17:0] << place(width, address)) & mask(width, address));
  endfunction

  function wide(input integer width);
    wide = width == 32 || width == 36;
  endfunction

  function [17:0] wide_mask(input integer width, input [1:0] enables);
    wide_mask = width == 32 ? {1'b0, {8{enables[1]}}, 1'b0, {8{enables[0]}}} : {{9{enables[1]}}, {9{enables[0]}}};
  endfunction

  wire [9:0] row_a = wide(WIDTH_A) ? {ADA[13:5], 1'b0} : ADA[13:4];
  wire [9:0] row_b = wide(WIDTH_B) ? {ADB[13:5], 1'b0} : ADB[13:4];
  wire [17:0] low_a = WIDTH_A == 32 ? spread(DIA[15:0]) : DIA[17:0];
  wire [17:0] high_a = WIDTH_A == 32 ? spread(DIA[31:16]) : DIA[35:18];

  always @(posedge CLKA) if (CEA) begin
    if (WREA) begin
      if (wide(WIDTH_A)) begin
        rows[row_a] <= (rows[row_a] & ~wide_mask(WIDTH_A, ADA[1:0])) | (low_a & wide_mask(WIDTH_A, ADA[1:0]));
        rows[row_a | 10'd1] <= (rows[row_a | 10'd1] & ~wide_mask(WIDTH_A, ADA[3:2])) |
                               (high_a & wide_mask(WIDTH_A, ADA[3:2]));
      end else begin
        rows[row_a] <= written(WIDTH_A, ADA, DIA, rows[row_a]);
      end
    end
    if (!WREA || MODE_A == 2) a_q <= read(WIDTH_A, ADA, rows[row_a], rows[row_a | 10'd1]);
    else if (MODE_A == 1) a_q <= DIA;
  end

  always @(posedge CLKB) if (CEB) begin
    if (WREB) rows[row_b] <= written(WIDTH_B, ADB, DIB, rows[row_b]);
    if (!WREB || MODE_B == 2) b_q <= read(WIDTH_B, ADB, rows[row_b], rows[row_b | 10'd1]);
    else if (MODE_B == 1) b_q <= DIB;
  end
endmodule
