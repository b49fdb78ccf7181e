// Types and constants that the modules of the ray tracer share.
//
// Frames of reference: the axes of the grid, x = 0, y = 1, z = 2. Positions count 1/16 voxel. A ray is traced in the
// mirrored grid, in which all components of its direction are >= 0.
//
// Structs are as wide as the largest configuration needs (DepthLimit, PositionLimit). A module uses the low bits of a
// field, as many as its parameters say; synthesis removes the others. Fields marked "signed" are to be read so.
//
// Parameters that many modules have (Lanes, MaxDepth, PositionBits, BlockBits, MemoryForm, L1SetBits, L2SetBits, Light,
// Mirrors, RayClocks, Lod) are those of voxrt_core, which says and checks their units and ranges. Each other parameter
// is checked by the module that uses it.
package voxrt_pkg;

  // The largest values of the parameters MaxDepth and PositionBits.
  localparam int unsigned DepthLimit = 16;
  localparam int unsigned PositionLimit = 32;

  // 1/16 voxel.
  localparam int unsigned FractionBits = 4;
  // Size of the camera's look, right and up.
  localparam int unsigned CameraBits = 16;
  // Image sizes are 1 .. 2**SizeBits - 1.
  localparam int unsigned SizeBits = 12;
  // look + right * (column - W/2) + up * (H/2 - row), for any registers.
  localparam int unsigned ScanBits = CameraBits + SizeBits + 1;
  // Components of a direction are refused from 2**DirectionBits on.
  localparam int unsigned DirectionBits = 20;
  // Weights: a product of two components.
  localparam int unsigned WeightBits = 2 * DirectionBits;

  // The wider side of the part's multipliers: 25 for the DSP48 of 7-series parts, 18 for most others.
`ifdef VOXRT_NARROW_MULTIPLIERS
  localparam int unsigned MultiplierBits = 18;
`else
  localparam int unsigned MultiplierBits = 25;
`endif

  // What the narrower side of a DSP48 takes of a number without sign.
  localparam int unsigned MultiplierSide = 17;

  // Entries of a lane's reorder buffer. A tag is the number of an entry and, above it, the buffer's phase bit.
  localparam int unsigned PixelDepth = 256;
  localparam int unsigned TagBits = $clog2(PixelDepth) + 1;

  // A ray's reach is its largest component times the frame's lod_scale / 2**LodScaleBits.
  localparam int unsigned LodScaleBits = 20;

  // Shadow rays count positions in 1/32 voxel.
  localparam int unsigned ShadowFractionBits = FractionBits + 1;
  // Reflections are at most 2**BounceBits - 1.
  localparam int unsigned BounceBits = 4;

  function automatic int larger(int a, int b);
    return a > b ? a : b;
  endfunction

  // T = (plane - origin) * weight needs the distance of any plane of the world from any position.
  function automatic int distance_bits(int max_depth, int position_bits);
    return $clog2(64'd2 ** (position_bits - 1) + 64'd2 ** (max_depth + FractionBits) + 1) + 1;
  endfunction

  // The same where each reflection moves the origin by less than the world's side.
  function automatic int reflected_distance_bits(int max_depth, int position_bits);
    return $clog2(64'd2 ** (position_bits - 1) + (64'd2 ** BounceBits + 1) * 64'd2 ** (max_depth + FractionBits) + 1) +
        1;
  endfunction

  // T as lanes compare it: modulo more than twice the time between any two planes of the world that a ray crosses in
  // it.
  function automatic int key_bits(int max_depth, bit light);
    return WeightBits + max_depth + (light ? ShadowFractionBits : FractionBits) + 1;
  endfunction

  // The light, in 1/16 voxel, signed: farther ones are farther than 2**DirectionBits from all of the world.
  function automatic int light_bits(int max_depth);
    return larger(max_depth + FractionBits + 1, DirectionBits) + 1;
  endfunction

  typedef logic [7:0] material_t;

  // Words of an octree, of 32 bits. The report dialect has {24'hFFFFFF, material} for a leaf, of which bit 31 decides,
  // and for a pointer the address of the block's first word, 1 + 8 * block. The dialect lod has {24'hFFFFFF, material}
  // and {block, mean material}.
  function automatic logic is_leaf(logic [31:0] word, logic lod_words);
    return lod_words ? word[31:8] == '1 : word[31];
  endfunction

  function automatic material_t material_of(logic [31:0] word);
    return word[7:0];
  endfunction

  // The address of the block's first word.
  function automatic logic [30:0] pointer_of(logic [31:0] word, logic lod_words);
    return lod_words ? {4'd0, word[31:8], 3'd1} : word[30:0];
  endfunction

  function automatic logic [31:0] leaf_word(material_t material);
    return {24'hFF_FFFF, material};
  endfunction

  function automatic logic [31:0] pointer_word(logic [23:0] block, material_t mean, logic lod_words);
    return lod_words ? {block, mean} : {5'd0, block, 3'd1};
  endfunction

  // A pointer that was refused reads as this word.
  localparam logic [31:0] RefusedWord = 32'h7FFF_FFFF;

  // Words as the lanes read them have a bit more than payload_bits. The highest bit tells a leaf, whose low bits are a
  // leaf_t. Of a pointer the low bits are the block, and with Lod the eight below the highest bit the mean material.
  typedef struct packed {
    logic      error;     // The pointer was refused, or the word did not come.
    material_t material;  // 0 with an error.
  } leaf_t;

  localparam leaf_t ErrorLeaf = '{error: 1'b1, material: '0};

  function automatic int payload_bits(int block_bits, bit lod);
    return larger(block_bits, $bits(leaf_t)) + (lod ? $bits(material_t) : 0);
  endfunction

  // Forms of the octree memory: the parameter MemoryForm.
  localparam int unsigned PrivateForm = 0;  // A copy per two lanes.
  localparam int unsigned BankedForm = 1;  // One memory in banks.
  localparam int unsigned CachedForm = 2;  // An external memory behind caches.

  // Clocks from an address of the octree memory to its word.
  function automatic int memory_clocks(int form);
    return form == int'(PrivateForm) ? 2 : 5;
  endfunction

  // Clocks from an address of the memory port to its word: one more, for a register, so that the port may be far away.
  function automatic int access_clocks(int form);
    return 1 + memory_clocks(form);
  endfunction

  // Rays in the ring of a lane.
  function automatic int lane_slots(int clocks);
    return 10 + clocks;
  endfunction

  // Whether there are so many lanes that wires to and from all of them are the longest paths.
  function automatic bit many_lanes(int lanes);
    return lanes > 4;
  endfunction

  // Lines that a lane's cache asks for at a time. Each set asks for one at most.
  function automatic int l1_outstanding(int set_bits);
    return set_bits < 3 ? 2 ** set_bits : 8;
  endfunction

  // Widths of the structs below.
  localparam int unsigned DistanceLimit = distance_bits(DepthLimit, PositionLimit);
  localparam int unsigned KeyLimit = key_bits(DepthLimit, 1'b1);
  localparam int unsigned PointLimit = DepthLimit + FractionBits;
  localparam int unsigned ShadowPointLimit = DepthLimit + ShadowFractionBits + 2;
  localparam int unsigned RowLimit = 6;  // Bits of the number of a row of weights.
  localparam int unsigned ReachLimit = DistanceLimit - FractionBits;

  // The axis of a plane; FaceNone where none was crossed. The order of the codes is the order of planes that are
  // crossed at the same time.
  typedef enum logic [1:0] {
    FaceX    = 2'd0,
    FaceY    = 2'd1,
    FaceZ    = 2'd2,
    FaceNone = 2'd3
  } face_e;

  typedef struct packed {
    material_t material;
    face_e     face;
  } pixel_t;

  typedef struct packed {
    logic [7:0] red;
    logic [7:0] green;
    logic [7:0] blue;
  } colour_t;

  // An entry of the material table.
  typedef struct packed {
    logic    mirror;
    colour_t colour;
  } material_entry_t;

  // A write to the material table.
  typedef struct packed {
    logic            valid;
    material_t       material;
    material_entry_t entry;
  } material_write_t;

  // A brightness per face, by {looks along +axis, axis}, 1/FaceUnit.
  typedef logic [1:0][2:0][7:0] faces_t;
  localparam int unsigned FaceUnit = 255;

  // The shader's features that a frame uses: docs/shading.md.
  typedef struct packed {
    logic                  flat;
    logic                  faces;       // Each face has its own brightness, unless flat.
    faces_t                brightness;
    logic                  light;
    logic [7:0]            ambient;     // 1/256
    logic [BounceBits-1:0] bounces;     // 0: mirrors are like all others.
  } shading_t;

  // A frame, as the registers describe it. Camera and light: grid frame, signed, 1/16 voxel; look, right, up: signed.
  typedef struct packed {
    logic [31:0]                memory_base;  // Byte address in the external memory: voxrt_line_reader.
    logic [2:0][31:0]           position;
    logic [2:0][CameraBits-1:0] look;
    logic [2:0][CameraBits-1:0] right;
    logic [2:0][CameraBits-1:0] up;
    logic [SizeBits-1:0]        width;
    logic [SizeBits-1:0]        height;
    logic [4:0]                 depth;
    logic [31:0]                root;         // Word address.
    shading_t                   shading;
    logic [2:0][31:0]           light;
    logic                       lod_words;    // The octree memory is in the dialect lod.
    logic [LodScaleBits-1:0]    lod_scale;    // 0: rays stop at leaves alone.
  } frame_t;

  // The world of a frame; held during it.
  typedef struct packed {
    logic [2:0][DistanceLimit-1:0] origin;           // Origin of the camera's rays, signed.
    logic [2:0][DistanceLimit-1:0] mirrored_origin;  // 16 * side - origin, signed.
    logic [4:0]                    depth;
    logic [DepthLimit:0]           side;             // Voxels, one-hot.
    logic [DepthLimit-1:0]         outside_mask;     // Bits of a voxel's coordinate that are 0 in the world.
  } world_t;

  // What the ray generators of a frame need. Right, width and height are held during the frame.
  typedef struct packed {
    logic                       start;
    logic                       corner;     // line_step is the direction of the top left pixel; later it is -up.
    logic [2:0][ScanBits-1:0]   line_step;  // Signed.
    logic [2:0][CameraBits-1:0] right;      // Signed.
    logic [SizeBits-1:0]        width;
    logic [SizeBits-1:0]        height;
  } raster_t;

  // The place of the light among the planes of each axis, in the grid's frame ([0]) and mirrored ([1]).
  typedef struct packed {
    logic [1:0][2:0][DepthLimit:0] occluder;  // A plane of lower number is between a point and the light.
    logic [1:0][2:0][DepthLimit:0] backface;  // A face in a plane of lower number is turned away from the light.
  } light_planes_t;

  typedef logic [2:0][WeightBits-1:0] weights_t;

  // A ray that has entered the world, in the mirrored frame. Its weights travel apart.
  typedef struct packed {
    logic                          resolved;    // The result is known: nothing to trace.
    pixel_t                        pixel;       // What a resolved ray of the camera shows.
    logic                          lit;         // Whether a resolved shadow ray reaches the light.
    logic                          shadow;
    logic [TagBits-1:0]            tag;         // The entry of a shadow ray's pixel.
    logic [2:0]                    mirrored;    // Axes.
    logic [2:0]                    dead;        // Axes on which the ray does not move.
    logic [2:0]                    octant;      // The first octant of the root.
    logic [KeyLimit-1:0]           entry_time;
    face_e                         entry_face;
    logic [2:0][DistanceLimit-1:0] origin;      // Signed; 1/32 voxel for shadow rays.
    logic [ReachLimit-1:0]         reach;       // See voxrt_lod.
  } ray_t;

  // The weights of a ray go to its lane before it does, into a row that is free.
  typedef struct packed {
    logic                  valid;
    logic [RowLimit-1:0]   row;
    weights_t              weights;
    logic [ReachLimit-1:0] reach;
  } weights_write_t;

  typedef struct packed {
    logic                valid;
    logic [RowLimit-1:0] row;
  } row_free_t;

  // A hit point that the light may reach: a cell of 1/16 voxel behind a face, mirrored frame.
  typedef struct packed {
    logic [TagBits-1:0]         tag;
    face_e                      face;
    logic [2:0]                 mirrored;
    logic [2:0][PointLimit-1:0] point;
  } hit_point_t;

  // A shadow ray before the ray setup: from a point, 1/32 voxel, in a direction; grid frame, both signed.
  typedef struct packed {
    logic [TagBits-1:0]               tag;
    logic [2:0][ShadowPointLimit-1:0] point;
    logic [2:0][ScanBits-1:0]         direction;
  } shadow_ray_t;

  // What a ray does with the word of its cell.
  typedef enum logic [1:0] {
    Retry,    // No word came.
    Descend,  // Into the block of a pointer.
    Leave,    // An empty leaf, through one of its faces.
    Finish    // Hit or error.
  } action_e;

  // A ray at stage 9 of a lane.
  typedef struct packed {
    logic                       done;       // It has hit, left the world, or met an error.
    logic                       continues;  // It goes on. Neither is high where no ray is.
    material_t                  material;   // The material of the word read; 0 without a hit.
    face_e                      key_face;   // The face of the plane crossed last.
    logic [2:0]                 mirrored;
    logic [2:0][DepthLimit-1:0] corner;     // The corner of the cell read.
    logic [2:0]                 set;        // Axes on which the next corner has the bit of the next size.
  } step_t;

  // What the slot scheduler decides at stage 9 of a lane.
  typedef struct packed {
    logic                         issues;    // The ray that waits gets the slot.
    logic                         bypasses;  // The ray that waits is resolved: it needs no slot.
    logic                         reflects;  // The ray of the slot starts again at the root.
    logic                         keeps;     // The slot keeps its ray.
    logic signed [DepthLimit+1:0] shift;     // How far a reflected ray's origin moves: side - 2 * plane, voxels.
    logic [2:0]                   mirrored;  // The axes of the slot's ray from now on.
    logic [2:0]                   set;       // See step_t; from now on.
  } decision_t;

  // What rays are, in the stages of a lane that ask.
  typedef struct packed {
    logic      waits0;     // It has hit, and waits for voxrt_hit_point.
    logic      waits2;
    material_t material2;  // What it has hit.
    logic      shadow1;
    logic      shadow2;
    logic      shadow3;
  } ray_modes_t;

  // What a lane tells its reorder buffer of a pixel.
  typedef struct packed {
    logic               complete;  // Nothing more comes; the pixel is stored now or was before.
    logic               store;
    logic [TagBits-1:0] tag;
    logic               lit;       // Valid with complete.
  } result_t;

  // What a pixel's colour is made of. In the reorder buffer, a payload is below it.
  typedef enum logic [1:0] {
    ShadeAngle,  // The material, by the ray's own angle or by its face: as below, point not used.
    ShadeMean,   // The mean of mirrors: a mirrors_t.
    ShadeLight   // The material, lit or in shadow: {mirrored, point[2], point[1], point[0]}; without Light {mirrored}.
  } shade_e;

  // Sums of colours, and of how many.
  localparam int unsigned ColourSumBits = 8 + BounceBits;
  typedef struct packed {
    logic [2:0][ColourSumBits-1:0] total;  // Red is 0.
    logic [BounceBits:0]           count;
  } mirrors_t;

  // The brightness of a pixel without light, 1/FaceUnit, where it does not depend on the angle. Upper: the face looks
  // along its axis.
  function automatic logic [7:0] face_brightness(faces_t brightness, logic flat, face_e face, logic upper);
    unique case (face)
      FaceX:   face_brightness = brightness[upper][0];
      FaceY:   face_brightness = brightness[upper][1];
      FaceZ:   face_brightness = brightness[upper][2];
      default: face_brightness = 8'(FaceUnit);
    endcase
    if (flat) face_brightness = 8'(FaceUnit);
  endfunction

  // What the shader takes instead of colour * (d_a**2 / |d|**2): sum * part / whole.
  localparam int unsigned SquareBits = 2 * DirectionBits;
  typedef struct packed {
    logic                          part_given;  // part / whole is valid.
    logic                          sum_given;   // sum is valid.
    logic [SquareBits-1:0]         part;
    logic [SquareBits+1:0]         whole;
    logic [2:0][ColourSumBits-1:0] sum;
  } brightness_t;

  // A pixel of the picture.
  typedef struct packed {
    colour_t colour;
    pixel_t  pixel;
    logic    first;     // The first pixel of the frame.
    logic    line_end;
    logic    last;      // The last pixel of the frame.
  } shaded_pixel_t;

  // Why a pixel may be wrong.
  typedef struct packed {
    // The bus to the external memory has not answered, or with an error: rays that needed it ended without a hit.
    logic bus_timeout;
    logic bus_error;
    // A direction component of 2**20 or more: the ray was not traced.
    logic direction_overflow;
    // A pointer that leads out of the memory or into the middle of a block.
    logic bad_pointer;
    // A pointer below the deepest level: the memory is cyclic, or deeper than the depth register says. Every pointer
    // read goes a level down and every leaf read increases the key, so this is the only way a ray could run for ever.
    logic step_limit;
  } error_t;

  // What a frame has cost.
  typedef struct packed {
    logic [31:0] word_requests;  // Lanes have asked for a word, which they did not always get.
    logic [31:0] line_requests;  // Caches of lanes have asked for a line.
    logic [31:0] lines_read;     // Lines of 32 bytes, from the external memory.
    logic [31:0] cycles;         // Clocks from the start to the last pixel accepted.
    logic [31:0] rays;           // Pixels accepted.
    logic [31:0] words_read;
    logic [31:0] hits;           // Pixels accepted that show a material.
    logic [31:0] stalls;         // Clocks in which a pixel waited to be accepted.
  } counters_t;

  // The detail of a pixel between lane and shader: {shade, payload}.
  function automatic int detail_bits(int max_depth, bit light, bit mirrors);
    return $bits(shade_e) + larger(light ? 3 + 3 * (max_depth + FractionBits) : 1, mirrors ? $bits(mirrors_t) : 1);
  endfunction

  // A pixel between lane and shader: its detail and a pixel_t below it; or the pixel_t alone.
  function automatic int pixel_bits(int max_depth, bit light, bit mirrors);
    return (light || mirrors ? detail_bits(max_depth, light, mirrors) : 0) + $bits(pixel_t);
  endfunction

  // External memory: AXI4 read ports, bursts of 4 beats of 64 bits.
  localparam int unsigned BusPorts = 2;
  typedef struct packed {
    logic        arvalid;
    logic [31:0] araddr;
    logic        rready;
  } axi_read_request_t;
  typedef struct packed {
    logic        arready;
    logic        rvalid;
    logic [63:0] rdata;
    logic [1:0]  rresp;
  } axi_read_response_t;

  // What the octree memory meets at a clock.
  typedef struct packed {
    logic       bus_error;
    logic       bus_timeout;
    logic [7:0] word_requests;  // How many, as counters_t has them.
    logic [7:0] line_requests;
    logic       lines_read;
  } memory_events_t;

  // Strips of lines, in which rays of a core with caches are issued: 16 lines, or 8 for up to 8 lanes, so that a lane's
  // rays are side by side. Pictures wider than 1024 or 2048 pixels have strips of a half or a quarter of that: so a strip
  // has 2**strip_bits(lanes) pixels at most.
  localparam int unsigned StripLineLimit = 4;
  localparam int unsigned StripLimit = 10 + StripLineLimit;

  function automatic int strip_bits(int lanes);
    return lanes > 8 ? 14 : 13;
  endfunction

  function automatic logic [2:0] strip_line_bits(int lanes, logic [SizeBits-1:0] width);
    return 3'(strip_bits(lanes) - (width <= SizeBits'(1024) ? 10 : width <= SizeBits'(2048) ? 11 : 12));
  endfunction

  // A pixel's place in a strip, in the order of voxrt_strip_place.
  typedef struct packed {
    logic                  last_line;     // The last line of the strip.
    logic                  last_of_half;  // The last column of its half of the picture.
    logic                  last_column;   // The last one of the strip, or of the line.
    logic                  last_strip;    // The last strip of the frame.
    logic                  leftwards;     // The next column of the half is the one to the left.
    logic [StripLimit-1:0] address;
  } strip_place_t;

endpackage
