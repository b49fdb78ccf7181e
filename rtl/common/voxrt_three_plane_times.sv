// The times at which a ray crosses a plane of each axis. With RayClocks = 1 each axis has a unit of its own, and times
// come three clocks later. With RayClocks = 4 one unit serves all, for parts with few multipliers, and times come three
// beats later. Values stay for a beat (voxrt_turns).
module voxrt_three_plane_times
  import voxrt_pkg::*;
#(
  parameter int unsigned RayClocks    = 1,
  parameter int unsigned DistanceBits = 18,                        // See voxrt_plane_time.
  parameter int unsigned TimeBits     = DistanceBits + WeightBits
) (
  input  logic                           clk_i,
  input  logic        [             1:0] turn_i,
  input  logic                           advance_i,
  input  logic signed [DistanceBits-1:0] distance_i[3],  // Plane minus origin, 1/16 voxel.
  input  logic        [  WeightBits-1:0] weight_i  [3],
  output logic signed [    TimeBits-1:0] time_o    [3]
);
  if (RayClocks == 1) begin : gen_own
    logic unused;
    assign unused = &{turn_i, advance_i};

    for (genvar a = 0; a < 3; a++) begin : gen_axis
      voxrt_plane_time #(
        .DistanceBits(DistanceBits),
        .TimeBits    (TimeBits)
      ) u_time (
        .clk_i,
        .distance_i(distance_i[a]),
        .weight_i  (weight_i[a]),
        .time_o    (time_o[a])
      );
    end
  end else begin : gen_shared
    logic signed [DistanceBits-1:0] distance;
    logic [WeightBits-1:0] weight;
    logic [TimeBits-1:0] plane_time;
    logic [TimeBits-1:0] times[3];

    always_comb begin
      distance = distance_i[2];
      weight   = weight_i[2];
      for (int unsigned a = 0; a < 2; a++) begin
        if (turn_i == 2'(a)) begin
          distance = distance_i[a];
          weight   = weight_i[a];
        end
      end
      for (int unsigned a = 0; a < 3; a++) time_o[a] = times[a];
    end

    voxrt_plane_time #(
      .DistanceBits(DistanceBits),
      .TimeBits    (TimeBits)
    ) u_time (
      .clk_i,
      .distance_i(distance),
      .weight_i  (weight),
      .time_o    (plane_time)
    );

    voxrt_collect #(
      .Width (TimeBits),
      .Clocks(3),
      .Beats (3)
    ) u_collect (
      .clk_i,
      .turn_i,
      .advance_i,
      .result_i (plane_time),
      .results_o(times)
    );
  end
endmodule
