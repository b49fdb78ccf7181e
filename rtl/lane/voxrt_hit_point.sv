// The hit point of a camera's ray: in which of the sub-cells of 1/16 voxel of its leaf it is. This needs a division,
// which takes longer than a turn of the ring. So it is done beside the ring of voxrt_lane, and the slot is free for
// another ray.
//
// On each axis the ray has crossed the planes whose keys (T, axis) are at most its own. T grows by the weight from a
// plane to the next, so their number behind the leaf's near plane is floor(since / weight), where since is the ray's T
// less that of the near plane; one less where, at equal T, the plane comes after the ray's key. It is below 16 times the
// leaf's size. A division without restoring gives a bit per clock on all axes: twice the remainder, less the weight, or
// plus it where the remainder is negative.
//
// A leaf of 2**level voxels has a number of level + 4 bits. Of the bits above, which are 0, none, Skip or 2 * Skip are
// left out: a division takes level + 4 clocks and Skip more at most.
//
// Two places. The first is given to a ray at stage 3, when its weights are read; it gets since at stage 6. At stage 9
// voxrt_slot_scheduler says whether the ray is taken: there it is known whether the light may reach its face. The second
// place divides. A ray that hits while the first place is not free goes round once more.
`include "voxrt_assert.svh"

module voxrt_hit_point
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10
) (
  input  logic                                      clk_i,
  input  logic                                      rst_ni,
  // Stage 3: a ray hits, and may be one to take.
  input  logic                                      hit3_i,
  input  weights_t                                  weights3_i,
  // Stage 6: -1 - since, signed; the leaf's size, one-hot.
  input  logic       [key_bits(MaxDepth, 1'b1)-1:0] until6_i   [3],
  input  logic       [                MaxDepth-1:0] size6_i,
  // Stage 9: whether the ray there has a place. If it is taken: what is known of its hit point, which is the corner of
  // its leaf, and its material.
  output logic                                      holds9_o,
  input  logic                                      takes9_i,        // Only with holds9_o.
  input  hit_point_t                                hit9_i,
  input  material_t                                 material9_i,
  // Hit points, in order.
  output logic                                      valid_o,
  input  logic                                      ready_i,
  output hit_point_t                                hit_point_o,
  output material_t                                 material_o
);
  // The largest leaf is half of the world.
  localparam int unsigned Bits = MaxDepth - 1 + FractionBits;
  localparam int unsigned SinceBits = WeightBits + Bits;
  localparam int unsigned CountBits = $clog2(Bits + 1);
  localparam int unsigned Skip = (MaxDepth + 2) / 3;

  // Whether a ray comes to the second place, and how many bits are left out.
  typedef enum logic [1:0] {
    Stay,
    MoveAll,
    MoveSkip,
    MoveSkip2
  } move_e;

  function automatic move_e move_of(logic [MaxDepth-1:0] size);
    logic [1:0] move = '0;
    for (int unsigned level = 0; level < MaxDepth; level++) begin
      if (size[level]) move |= 2'(1 + (MaxDepth - 1 - level) / Skip);
    end
    return move_e'(move);
  endfunction

  // The first place.
  logic [9:4] held_q;  // The stage that its ray is in, one-hot.
  logic taken_q;  // The ray is taken: it waits for the second place.
  weights_t weights_q;
  logic [2:0][SinceBits-1:0] until_q;
  move_e move_q, move;
  hit_point_t hit_q;
  material_t material_q;
  logic holds3;

  assign holds3   = hit3_i && held_q == '0 && !taken_q;
  assign holds9_o = held_q[9];

  always_ff @(posedge clk_i) begin
    held_q <= {held_q[8:4], holds3};
    if (takes9_i) taken_q <= 1'b1;
    else if (move != Stay) taken_q <= 1'b0;
    if (holds3) weights_q <= weights3_i;
    if (held_q[6]) begin
      for (int unsigned a = 0; a < 3; a++) until_q[a] <= until6_i[a][SinceBits-1:0];
      move_q <= move_of(size6_i);
    end
    if (held_q[9]) begin
      hit_q      <= hit9_i;
      material_q <= material9_i;
    end
    if (!rst_ni) begin
      held_q  <= '0;
      taken_q <= 1'b0;
    end
  end

  // The second place. The bits found take the place of the lower bits of since.
  logic busy_q, done_q;
  logic [CountBits-1:0] left_q;
  weights_t divisor_q;
  logic [2:0][WeightBits:0] remainder_q, sum;  // Signed.
  logic [2:0][Bits-1:0] lower_q;
  logic [2:0][SinceBits-1:0] since, next;  // Remainder and lower bits, without the sign.
  hit_point_t result_q;
  material_t result_material_q;

  assign move = taken_q && !busy_q ? move_q : Stay;

  always_comb begin
    since = ~until_q;
    for (int unsigned a = 0; a < 3; a++) begin
      sum[a] = {remainder_q[a][WeightBits-1:0], lower_q[a][Bits-1]} +
          (remainder_q[a][WeightBits] ? {1'b0, divisor_q[a]} : ~{1'b0, divisor_q[a]}) +
          (WeightBits + 1)'(!remainder_q[a][WeightBits]);
      unique case (move)
        MoveAll:   next[a] = since[a];
        MoveSkip:  next[a] = since[a] << Skip;
        MoveSkip2: next[a] = since[a] << (2 * Skip);
        default:   next[a] = {sum[a][WeightBits-1:0], lower_q[a][Bits-2:0], !sum[a][WeightBits]};
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (move != Stay) begin
      divisor_q         <= weights_q;
      result_q          <= hit_q;
      result_material_q <= material_q;
    end
    unique case (move)
      MoveAll:   left_q <= CountBits'(Bits);
      MoveSkip:  left_q <= CountBits'(Bits - Skip);
      MoveSkip2: left_q <= CountBits'(Bits - 2 * Skip);
      default:   left_q <= left_q - 1'b1;
    endcase
    if (move != Stay || (busy_q && !done_q)) begin
      for (int unsigned a = 0; a < 3; a++) begin
        {remainder_q[a][WeightBits-1:0], lower_q[a]} <= next[a];
        remainder_q[a][WeightBits]                   <= move == Stay && sum[a][WeightBits];
      end
    end
    busy_q <= move != Stay || (busy_q && !(done_q && ready_i));
    done_q <= done_q ? !ready_i : busy_q && left_q == CountBits'(1);
    if (!rst_ni) begin
      busy_q <= 1'b0;
      done_q <= 1'b0;
    end
  end

  assign valid_o    = done_q;
  assign material_o = result_material_q;

  always_comb begin
    hit_point_o = result_q;
    for (int unsigned a = 0; a < 3; a++) hit_point_o.point[a] = result_q.point[a] | PointLimit'(lower_q[a]);
  end

  `VOXRT_ASSERT(TakenRayHasPlace, !takes9_i || holds9_o)
  `VOXRT_ASSERT(PlaceHasOneRay, !takes9_i || !taken_q)
  for (genvar a = 0; a < 3; a++) begin : gen_check
    `VOXRT_ASSERT(RayIsInItsLeaf, move == Stay || since[a][SinceBits-1:Bits] < weights_q[a])
    `VOXRT_ASSERT(PointIsInItsLeaf, !valid_o || (result_q.point[a] & PointLimit'(lower_q[a])) == '0)
  end
endmodule
