// From sub-cells that rays of the camera met to shadow rays: where from, which way, for all lanes.
//
// Lanes have their turns one after another: a turn every Lanes clocks is enough for a lane, whose rays read a dozen words
// each between two requests. A lane has at most QueueDepth shadow rays under way, from its request until it starts the
// ray (started_i); it may make a request while ready_o is high, and at a clock in which it starts a shadow ray.
module voxrt_light
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes      = 1,
  parameter  int unsigned MaxDepth   = 10,
  parameter  int unsigned TagBits    = 8,
  parameter  int unsigned QueueDepth = 16,
  localparam int unsigned PlaceBits  = MaxDepth + FractionBits,
  localparam int unsigned LitBits    = MaxDepth + LitFractionBits + 2,
  localparam int unsigned LightBits  = light_bits(MaxDepth)
) (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  // Held during a frame.
  input  logic        [   MaxDepth:0] world_i,            // One-hot: the world's side.
  input  logic signed [LightBits-1:0] light_i    [3],     // 1/16 voxel.
  // Requests, as voxrt_lane makes them.
  input  logic        [    Lanes-1:0] request_i,
  output logic        [    Lanes-1:0] ready_o,
  input  logic        [  TagBits-1:0] tag_i      [Lanes],
  input  face_e                       face_i     [Lanes],
  input  logic        [          2:0] mirrored_i [Lanes],
  input  logic        [PlaceBits-1:0] place_i    [Lanes][3],
  input  logic        [    Lanes-1:0] started_i,
  // To voxrt_ray_setup, which always takes them.
  output logic                        valid_o,
  output logic        [    Lanes-1:0] lane_o,
  output logic        [  TagBits-1:0] tag_o,
  output logic signed [  LitBits-1:0] lit_o      [3],     // 1/32 voxel.
  output logic signed [ ScanBits-1:0] way_o      [3],
  // Which planes are before the light, and which are not behind it: those of lower number than these. In the grid's frame,
  // [0], and mirrored, [1].
  output logic        [   MaxDepth:0] before_light_o[2][3],
  output logic        [   MaxDepth:0] to_light_o [2][3]
);
  localparam int unsigned CountBits = $clog2(QueueDepth) + 1;

  typedef struct packed {
    logic [TagBits-1:0]        tag;
    face_e                     face;
    logic [2:0]                mirrored;
    logic [2:0][PlaceBits-1:0] place;
  } request_t;

  logic     [Lanes-1:0] waiting, turn_q;  // One-hot: whose turn it is.
  request_t             requests[Lanes];
  request_t             request;

  always_ff @(posedge clk_i) begin
    turn_q <= Lanes'({turn_q, turn_q[Lanes-1]});
    if (!rst_ni) turn_q <= Lanes'(1);
  end

  for (genvar i = 0; i < Lanes; i++) begin : gen_lane
    logic [CountBits-1:0] places_q;  // Of shadow rays that the lane may still ask for.
    logic                 unused_ready;

    assign ready_o[i] = places_q != '0;

    always_ff @(posedge clk_i) begin
      places_q <= places_q - CountBits'(request_i[i]) + CountBits'(started_i[i]);
      if (!rst_ni) places_q <= CountBits'(QueueDepth);
    end

    voxrt_fifo #(
      .Width($bits(request_t)),
      .Depth(QueueDepth)
    ) u_requests (
      .clk_i,
      .rst_ni,
      .valid_i(request_i[i]),
      .ready_o(unused_ready),
      .data_i ({tag_i[i], face_i[i], mirrored_i[i], place_i[i][2], place_i[i][1], place_i[i][0]}),
      .valid_o(waiting[i]),
      .ready_i(turn_q[i]),
      .data_o (requests[i])
    );
  end

  always_comb begin
    request = '0;
    for (int unsigned i = 0; i < Lanes; i++) if (turn_q[i]) request |= requests[i];
  end

  // The request, then the lit point, then the way.
  logic     [        2:0] valid_q;
  logic     [  Lanes-1:0] lane_q[3];
  logic     [TagBits-1:0] tag_q [1:2];
  request_t               request_q;
  logic signed [LightBits+1:0] way[3];
  logic [PlaceBits-1:0] place[3];

  always_ff @(posedge clk_i) begin
    valid_q      <= rst_ni ? {valid_q[1:0], (waiting & turn_q) != '0} : '0;
    lane_q[0]    <= turn_q;
    request_q    <= request;
    lane_q[1:2]  <= lane_q[0:1];
    tag_q        <= '{request_q.tag, tag_q[1]};
  end

  always_comb for (int unsigned a = 0; a < 3; a++) place[a] = request_q.place[a];

  voxrt_light_way #(
    .MaxDepth(MaxDepth)
  ) u_way (
    .clk_i,
    .enable_i  (1'b1),
    .world_i,
    .light_i,
    .place_i   (place),
    .mirrored_i(request_q.mirrored),
    .face_i    (request_q.face),
    .lit_o,
    .way_o     (way)
  );

  // The light among the planes.
  localparam int unsigned Voxel = 2 ** FractionBits;
  logic        [   MaxDepth:0] before_light_q[2][3], to_light_q[2][3];
  logic signed [LightBits-1:0] mirrored_light[3];

  function automatic logic [MaxDepth:0] plane_at(logic signed [LightBits-1:0] height, logic [MaxDepth:0] world);
    logic signed [LightBits-1:0] plane = height >>> FractionBits;
    if (plane < 0) return '0;
    return plane > LightBits'(world) ? world : plane[MaxDepth:0];
  endfunction

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) mirrored_light[a] = LightBits'({world_i, FractionBits'(0)}) - light_i[a];
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      before_light_q[0][a] <= plane_at(light_i[a] + LightBits'(Voxel - 1), world_i);
      before_light_q[1][a] <= plane_at(mirrored_light[a] + LightBits'(Voxel - 1), world_i);
      to_light_q[0][a]     <= plane_at(light_i[a] + LightBits'(Voxel), world_i);
      to_light_q[1][a]     <= plane_at(mirrored_light[a] + LightBits'(Voxel), world_i);
    end
  end

  assign before_light_o = before_light_q;
  assign to_light_o     = to_light_q;

  assign valid_o = valid_q[2];
  assign lane_o  = lane_q[2];
  assign tag_o   = tag_q[2];

  always_comb for (int unsigned a = 0; a < 3; a++) way_o[a] = ScanBits'(way[a]);
endmodule
