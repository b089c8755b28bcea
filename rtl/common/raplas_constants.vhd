-- ============================================================================
-- raplas_constants - format widths, stage counts, word layouts, counters
-- ----------------------------------------------------------------------------
-- Generated from raplas.toml by scripts/constants.py: change it there.
-- model: cmodel/include/raplas/constants.hpp
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;

package raplas_constants is

  -- fp24: bits of the exponent field
  constant EXPONENT_BITS : natural := 7;
  -- fp24: bits of the fraction field; the significand has one more, the hidden one
  constant FRACTION_BITS : natural := 16;
  -- fp24: value = significand * 2^(exponent - EXPONENT_BIAS - FRACTION_BITS)
  constant EXPONENT_BIAS : natural := 63;
  -- fp24: width of a word: sign, exponent, fraction
  constant FP_BITS : natural := 24;
  -- latency of fp_add, clocks
  constant ADD_STAGES : natural := 4;
  -- latency of fp_mul, clocks
  constant MUL_STAGES : natural := 3;
  -- latency of the compare at the end of a plane-sphere tester, clocks
  constant COMPARE_STAGES : natural := 1;
  -- latency of every memory read port, clocks
  constant MEMORY_STAGES : natural := 2;
  -- most row planes of a pencil (M)
  constant MAX_ROWS : natural := 16;
  -- most column planes of a pencil (N)
  constant MAX_COLUMNS : natural := 16;
  -- bits of a row or column number; ray ID = row * MAX_COLUMNS + column
  constant LINE_BITS : natural := 4;
  -- bits of a sphere, vertex or triangle ID (the address in its memory)
  constant ID_BITS : natural := 21;
  -- bits of the number of children (spheres or triangles) of a node
  constant COUNT_BITS : natural := 7;
  -- bits of each event counter
  constant COUNTER_BITS : natural := 32;
  -- entries of the traversal stack
  constant STACK_DEPTH : natural := 128;
  -- STACK_DEPTH = 2^7
  constant STACK_DEPTH_LOG2 : natural := 7;
  -- from this many stacked ranges on the traversal takes one range at a time
  constant STACK_WATERMARK : natural := 48;
  -- leaves waiting for the selector
  constant LEAF_FIFO_DEPTH : natural := 32;
  -- LEAF_FIFO_DEPTH = 2^5
  constant LEAF_FIFO_DEPTH_LOG2 : natural := 5;
  -- (ray, triangle) pairs waiting for the ray-triangle subunit
  constant PAIR_FIFO_DEPTH : natural := 16;
  -- PAIR_FIFO_DEPTH = 2^4
  constant PAIR_FIFO_DEPTH_LOG2 : natural := 4;
  -- fixed point: bits of a coordinate, a normal's component, a radius
  constant COORDINATE_BITS : natural := 18;
  -- fixed point: fraction bits of these three
  constant COORDINATE_FRACTION : natural := 17;
  -- fixed point: bits of a plane's offset (signed); LSB 2^-34
  constant OFFSET_BITS : natural := 36;
  -- fixed point: bits of n.x + p, radius added or taken off (signed); LSB 2^-34
  constant PLANE_SUM_BITS : natural := 40;
  -- latency of dsp_plane_test, clocks from its first operand
  constant PLANE_TEST_STAGES : natural := 6;
  -- depth code: bits of the exponent; code 0 stands for 0
  constant DEPTH_EXPONENT_BITS : natural := 5;
  -- depth code: bits of the fraction
  constant DEPTH_FRACTION_BITS : natural := 10;
  -- depth code of (1 + fraction / 2^10) 2^(exponent - 21); codes order as integers
  constant DEPTH_BITS : natural := 15;
  -- depth code: bias of the exponent
  constant DEPTH_BIAS : natural := 21;
  -- scan lines: bits of a vertex' row or column on the pencil's grid (signed)
  constant GRID_BITS : natural := 16;
  -- scan lines: fraction bits of these
  constant GRID_FRACTION : natural := 5;
  -- scan lines: bits of the two exponents in the grid's register
  constant GRID_EXPONENT_BITS : natural := 5;
  -- scan lines: bits of the grid's error class
  constant GRID_ERROR_BITS : natural := 2;
  -- scan lines: bits of a reciprocal of 1 .. 2, whose index has DEPTH_FRACTION_BITS
  constant RECIPROCAL_BITS : natural := 17;
  -- scan lines: bits of an edge's slope, columns a row (signed)
  constant SLOPE_BITS : natural := 18;
  -- scan lines: fraction bits of a slope
  constant SLOPE_FRACTION : natural := 12;
  -- scan lines: bits of the column where an edge cuts line 8 (signed)
  constant CUT_BITS : natural := 19;
  -- scan lines: fraction bits of this column
  constant CUT_FRACTION : natural := 7;
  -- latency of dsp_multiply_add, clocks from its factors
  constant MULTIPLY_ADD_STAGES : natural := 3;
  -- latency of row_interval, clocks: MULTIPLY_ADD_STAGES + 3
  constant ROW_INTERVAL_STAGES : natural := 6;
  -- latency of vertex_grid, clocks: MULTIPLY_ADD_STAGES, the shift before and the slot after
  constant VERTEX_GRID_STAGES : natural := 5;
  -- latency of edge_setup, clocks from the one in which a word is taken
  constant EDGE_SETUP_STAGES : natural := 13;
  -- latency of depth_code, clocks
  constant DEPTH_CODE_STAGES : natural := 2;
  -- depth code: taken off depths, for rays whose t is a little too small
  constant DEPTH_MARGIN : natural := 4;
  -- depth code: t / d is below the code that depth_quotient gives plus this
  constant QUOTIENT_ERROR : natural := 4;
  -- certified hits: exponent field of the band of rays whose length is 1
  constant BAND_EXPONENT : natural := 49;
  -- certified hits: t' or d below 2^-ROUGH_SHIFT of N's largest component makes the depth rough
  constant ROUGH_SHIFT : natural := 2;
  -- certified hits: below 2^-UNSURE_SHIFT of it the depth isn't known
  constant UNSURE_SHIFT : natural := 4;
  -- certified hits: below 2^-BLIND_SHIFT of it the sign isn't known
  constant BLIND_SHIFT : natural := 10;
  -- certified hits: depths less than 3 * 2^-TIE_SHIFT of their power of two apart are a tie
  constant TIE_SHIFT : natural := 8;
  -- certified hits: the same of depths of which one is rough, 2^-ROUGH_TIE_SHIFT
  constant ROUGH_TIE_SHIFT : natural := 4;
  -- certified hits: depth codes by which a ray's bound lies beyond what QUOTIENT_ERROR asks for
  constant BOUND_MARGIN : natural := 8;
  -- certified hits: the same of a hit whose depth is rough
  constant ROUGH_BOUND_MARGIN : natural := 32;
  -- pencils that the Plane, Ray and Result memories hold
  constant PENCIL_BANKS : natural := 4;
  -- PENCIL_BANKS = 2^2
  constant BANK_BITS : natural := 2;
  -- 2^2 rays of a row are one word of the host's write port
  constant WORD_RAYS_LOG2 : natural := 2;
  -- index of the near plane on the row side, of the depth plane on the column side
  constant AXIS_PLANE : natural := 16;
  -- index of the down plane on the row side, of the across plane on the column side
  constant GRID_PLANE : natural := 17;
  -- planes of a pencil on each of the two sides: 16 lines, and those two
  constant SIDE_PLANES : natural := 18;
  -- bits of a plane's index on its side
  constant PLANE_INDEX_BITS : natural := 5;
  -- entries at the top of the traversal stack among which the nearest comes first
  constant SORTED_RANGES : natural := 4;
  -- triangles that wait for the selector: 2^6
  constant TRIANGLE_FIFO_DEPTH_LOG2 : natural := 6;
  -- triangles with their edges that wait for the selector: 2^5
  constant CUT_FIFO_DEPTH_LOG2 : natural := 5;
  -- rows of triangles that wait for the selector's second half: 2^4
  constant ROW_FIFO_DEPTH_LOG2 : natural := 4;
  -- hits that wait for the nearest hit of their ray: 2^6
  constant HIT_FIFO_DEPTH_LOG2 : natural := 6;

  subtype fp24_t is std_ulogic_vector(FP_BITS - 1 downto 0);

  -- node of the sphere tree; children first .. first+count-1: triangles in a leaf, else spheres
  constant SPHERE_BITS : natural := 125;
  subtype sphere_word_t is std_ulogic_vector(124 downto 0);
  type sphere_t is record
    cx : fp24_t;
    cy : fp24_t;
    cz : fp24_t;
    r : fp24_t;
    leaf : std_ulogic;
    count : std_ulogic_vector(6 downto 0);
    first : std_ulogic_vector(20 downto 0);
  end record;
  function unpack_sphere(word : sphere_word_t) return sphere_t;
  function pack_sphere(fields : sphere_t) return sphere_word_t;

  -- vertex V0, edges E1 = V1-V0 and E2 = V2-V0, normal N = E1 x E2
  constant TRIANGLE_BITS : natural := 288;
  subtype triangle_word_t is std_ulogic_vector(287 downto 0);
  type triangle_t is record
    v0x : fp24_t;
    v0y : fp24_t;
    v0z : fp24_t;
    e1x : fp24_t;
    e1y : fp24_t;
    e1z : fp24_t;
    e2x : fp24_t;
    e2y : fp24_t;
    e2z : fp24_t;
    nx : fp24_t;
    ny : fp24_t;
    nz : fp24_t;
  end record;
  function unpack_triangle(word : triangle_word_t) return triangle_t;
  function pack_triangle(fields : triangle_t) return triangle_word_t;

  -- n.x + p = 0, n of unit length; address = bank * 32 + (row, or 16 + column)
  constant PLANE_BITS : natural := 96;
  subtype plane_word_t is std_ulogic_vector(95 downto 0);
  type plane_t is record
    nx : fp24_t;
    ny : fp24_t;
    nz : fp24_t;
    p : fp24_t;
  end record;
  function unpack_plane(word : plane_word_t) return plane_t;
  function pack_plane(fields : plane_t) return plane_word_t;

  -- unit direction; address = bank * 256 + ray ID, four in a word in profile raplas: that / 4
  constant RAY_BITS : natural := 72;
  subtype ray_word_t is std_ulogic_vector(71 downto 0);
  type ray_t is record
    dx : fp24_t;
    dy : fp24_t;
    dz : fp24_t;
  end record;
  function unpack_ray(word : ray_word_t) return ray_t;
  function pack_ray(fields : ray_t) return ray_word_t;

  -- register: common origin and size of a pencil (rows 1..16, columns 1..16); address = bank
  constant PENCIL_BITS : natural := 82;
  subtype pencil_word_t is std_ulogic_vector(81 downto 0);
  type pencil_t is record
    rows : std_ulogic_vector(4 downto 0);
    columns : std_ulogic_vector(4 downto 0);
    ox : fp24_t;
    oy : fp24_t;
    oz : fp24_t;
  end record;
  function unpack_pencil(word : pencil_word_t) return pencil_t;
  function pack_pencil(fields : pencil_t) return pencil_word_t;

  -- register: root range of the sphere tree, and number of spheres in the memory
  constant SCENE_BITS : natural := 65;
  subtype scene_word_t is std_ulogic_vector(64 downto 0);
  type scene_t is record
    spheres : std_ulogic_vector(21 downto 0);
    count : std_ulogic_vector(21 downto 0);
    first : std_ulogic_vector(20 downto 0);
  end record;
  function unpack_scene(word : scene_word_t) return scene_t;
  function pack_scene(fields : scene_t) return scene_word_t;

  -- nearest hit of a ray: t = t'/d, u = u'/d, v = v'/d; address = bank * 256 + ray ID
  constant RESULT_BITS : natural := 118;
  subtype result_word_t is std_ulogic_vector(117 downto 0);
  type result_t is record
    hit : std_ulogic;
    triangle : std_ulogic_vector(20 downto 0);
    t : fp24_t;
    d : fp24_t;
    u : fp24_t;
    v : fp24_t;
  end record;
  function unpack_result(word : result_word_t) return result_t;
  function pack_result(fields : result_t) return result_word_t;

  -- profile raplas: nearest hit of a ray, and what else it may hit; address = bank * 256 + ray ID
  constant RAY_HITS_BITS : natural := 144;
  subtype ray_hits_word_t is std_ulogic_vector(143 downto 0);
  type ray_hits_t is record
    hit : std_ulogic;
    crowd : std_ulogic;
    unsure : std_ulogic;
    rough : std_ulogic;
    rival : std_ulogic;
    rival_rough : std_ulogic;
    rival_triangle : std_ulogic_vector(20 downto 0);
    triangle : std_ulogic_vector(20 downto 0);
    t : fp24_t;
    d : fp24_t;
    u : fp24_t;
    v : fp24_t;
  end record;
  function unpack_ray_hits(word : ray_hits_word_t) return ray_hits_t;
  function pack_ray_hits(fields : ray_hits_t) return ray_hits_word_t;

  -- sphere in fixed point; children first .. first+count-1: vertices in a leaf, else nodes
  constant NODE_BITS : natural := 101;
  subtype node_word_t is std_ulogic_vector(100 downto 0);
  type node_t is record
    cx : std_ulogic_vector(17 downto 0);
    cy : std_ulogic_vector(17 downto 0);
    cz : std_ulogic_vector(17 downto 0);
    r : std_ulogic_vector(17 downto 0);
    leaf : std_ulogic;
    count : std_ulogic_vector(6 downto 0);
    first : std_ulogic_vector(20 downto 0);
  end record;
  function unpack_node(word : node_word_t) return node_t;
  function pack_node(fields : node_t) return node_word_t;

  -- vertex in fixed point, goes to a slot (0..2); emit: slots now hold the triangle
  constant VERTEX_BITS : natural := 78;
  subtype vertex_word_t is std_ulogic_vector(77 downto 0);
  type vertex_t is record
    x : std_ulogic_vector(17 downto 0);
    y : std_ulogic_vector(17 downto 0);
    z : std_ulogic_vector(17 downto 0);
    slot : std_ulogic_vector(1 downto 0);
    emit : std_ulogic;
    triangle : std_ulogic_vector(20 downto 0);
  end record;
  function unpack_vertex(word : vertex_word_t) return vertex_t;
  function pack_vertex(fields : vertex_t) return vertex_word_t;

  -- n.x + p = 0, |n| <= 1; two in a word, the row side low; address = bank * 32 + index
  constant FIXED_PLANE_BITS : natural := 90;
  subtype fixed_plane_word_t is std_ulogic_vector(89 downto 0);
  type fixed_plane_t is record
    nx : std_ulogic_vector(17 downto 0);
    ny : std_ulogic_vector(17 downto 0);
    nz : std_ulogic_vector(17 downto 0);
    p : std_ulogic_vector(35 downto 0);
  end record;
  function unpack_fixed_plane(word : fixed_plane_word_t) return fixed_plane_t;
  function pack_fixed_plane(fields : fixed_plane_t) return fixed_plane_word_t;

  -- register: band of certified hits; any hit; scan lines; slack; first far depth; address = bank
  constant LIMITS_BITS : natural := 70;
  subtype limits_word_t is std_ulogic_vector(69 downto 0);
  type limits_t is record
    band : fp24_t;
    any_hit : std_ulogic;
    scale : std_ulogic_vector(4 downto 0);
    least : std_ulogic_vector(4 downto 0);
    error : std_ulogic_vector(1 downto 0);
    slack : std_ulogic_vector(17 downto 0);
    far : std_ulogic_vector(14 downto 0);
  end record;
  function unpack_limits(word : limits_word_t) return limits_t;
  function pack_limits(fields : limits_t) return limits_word_t;

  -- codes of the host's write targets
  constant TARGET_SPHERE : natural := 0;
  constant TARGET_TRIANGLE : natural := 1;
  constant TARGET_PLANE : natural := 2;
  constant TARGET_RAY : natural := 3;
  constant TARGET_PENCIL : natural := 4;
  constant TARGET_SCENE : natural := 5;
  constant TARGET_VERTEX : natural := 6;
  constant TARGET_LIMITS : natural := 7;

  -- places of the counters in the counter bus, COUNTER_BITS each
  constant COUNTER_CYCLES : natural := 0;
  constant COUNTER_SPHERES_TESTED : natural := 1;
  constant COUNTER_SPHERES_SKIPPED : natural := 2;
  constant COUNTER_PLANE_TESTS : natural := 3;
  constant COUNTER_PAIRS_TESTED : natural := 4;
  constant COUNTER_HITS : natural := 5;
  constant COUNTER_STALL_CYCLES : natural := 6;
  constant COUNTER_VERTICES_TESTED : natural := 7;
  constant NUM_COUNTERS : natural := 8;

end package raplas_constants;

package body raplas_constants is

  function unpack_sphere(word : sphere_word_t) return sphere_t is
    variable fields_v : sphere_t;
  begin
    fields_v.cx := word(124 downto 101);
    fields_v.cy := word(100 downto 77);
    fields_v.cz := word(76 downto 53);
    fields_v.r := word(52 downto 29);
    fields_v.leaf := word(28);
    fields_v.count := word(27 downto 21);
    fields_v.first := word(20 downto 0);
    return fields_v;
  end function unpack_sphere;

  function pack_sphere(fields : sphere_t) return sphere_word_t is
  begin
    return fields.cx & fields.cy & fields.cz & fields.r
      & fields.leaf & fields.count & fields.first;
  end function pack_sphere;

  function unpack_triangle(word : triangle_word_t) return triangle_t is
    variable fields_v : triangle_t;
  begin
    fields_v.v0x := word(287 downto 264);
    fields_v.v0y := word(263 downto 240);
    fields_v.v0z := word(239 downto 216);
    fields_v.e1x := word(215 downto 192);
    fields_v.e1y := word(191 downto 168);
    fields_v.e1z := word(167 downto 144);
    fields_v.e2x := word(143 downto 120);
    fields_v.e2y := word(119 downto 96);
    fields_v.e2z := word(95 downto 72);
    fields_v.nx := word(71 downto 48);
    fields_v.ny := word(47 downto 24);
    fields_v.nz := word(23 downto 0);
    return fields_v;
  end function unpack_triangle;

  function pack_triangle(fields : triangle_t) return triangle_word_t is
  begin
    return fields.v0x & fields.v0y & fields.v0z & fields.e1x
      & fields.e1y & fields.e1z & fields.e2x & fields.e2y
      & fields.e2z & fields.nx & fields.ny & fields.nz;
  end function pack_triangle;

  function unpack_plane(word : plane_word_t) return plane_t is
    variable fields_v : plane_t;
  begin
    fields_v.nx := word(95 downto 72);
    fields_v.ny := word(71 downto 48);
    fields_v.nz := word(47 downto 24);
    fields_v.p := word(23 downto 0);
    return fields_v;
  end function unpack_plane;

  function pack_plane(fields : plane_t) return plane_word_t is
  begin
    return fields.nx & fields.ny & fields.nz & fields.p;
  end function pack_plane;

  function unpack_ray(word : ray_word_t) return ray_t is
    variable fields_v : ray_t;
  begin
    fields_v.dx := word(71 downto 48);
    fields_v.dy := word(47 downto 24);
    fields_v.dz := word(23 downto 0);
    return fields_v;
  end function unpack_ray;

  function pack_ray(fields : ray_t) return ray_word_t is
  begin
    return fields.dx & fields.dy & fields.dz;
  end function pack_ray;

  function unpack_pencil(word : pencil_word_t) return pencil_t is
    variable fields_v : pencil_t;
  begin
    fields_v.rows := word(81 downto 77);
    fields_v.columns := word(76 downto 72);
    fields_v.ox := word(71 downto 48);
    fields_v.oy := word(47 downto 24);
    fields_v.oz := word(23 downto 0);
    return fields_v;
  end function unpack_pencil;

  function pack_pencil(fields : pencil_t) return pencil_word_t is
  begin
    return fields.rows & fields.columns & fields.ox & fields.oy
      & fields.oz;
  end function pack_pencil;

  function unpack_scene(word : scene_word_t) return scene_t is
    variable fields_v : scene_t;
  begin
    fields_v.spheres := word(64 downto 43);
    fields_v.count := word(42 downto 21);
    fields_v.first := word(20 downto 0);
    return fields_v;
  end function unpack_scene;

  function pack_scene(fields : scene_t) return scene_word_t is
  begin
    return fields.spheres & fields.count & fields.first;
  end function pack_scene;

  function unpack_result(word : result_word_t) return result_t is
    variable fields_v : result_t;
  begin
    fields_v.hit := word(117);
    fields_v.triangle := word(116 downto 96);
    fields_v.t := word(95 downto 72);
    fields_v.d := word(71 downto 48);
    fields_v.u := word(47 downto 24);
    fields_v.v := word(23 downto 0);
    return fields_v;
  end function unpack_result;

  function pack_result(fields : result_t) return result_word_t is
  begin
    return fields.hit & fields.triangle & fields.t & fields.d
      & fields.u & fields.v;
  end function pack_result;

  function unpack_ray_hits(word : ray_hits_word_t) return ray_hits_t is
    variable fields_v : ray_hits_t;
  begin
    fields_v.hit := word(143);
    fields_v.crowd := word(142);
    fields_v.unsure := word(141);
    fields_v.rough := word(140);
    fields_v.rival := word(139);
    fields_v.rival_rough := word(138);
    fields_v.rival_triangle := word(137 downto 117);
    fields_v.triangle := word(116 downto 96);
    fields_v.t := word(95 downto 72);
    fields_v.d := word(71 downto 48);
    fields_v.u := word(47 downto 24);
    fields_v.v := word(23 downto 0);
    return fields_v;
  end function unpack_ray_hits;

  function pack_ray_hits(fields : ray_hits_t) return ray_hits_word_t is
  begin
    return fields.hit & fields.crowd & fields.unsure & fields.rough
      & fields.rival & fields.rival_rough & fields.rival_triangle & fields.triangle
      & fields.t & fields.d & fields.u & fields.v;
  end function pack_ray_hits;

  function unpack_node(word : node_word_t) return node_t is
    variable fields_v : node_t;
  begin
    fields_v.cx := word(100 downto 83);
    fields_v.cy := word(82 downto 65);
    fields_v.cz := word(64 downto 47);
    fields_v.r := word(46 downto 29);
    fields_v.leaf := word(28);
    fields_v.count := word(27 downto 21);
    fields_v.first := word(20 downto 0);
    return fields_v;
  end function unpack_node;

  function pack_node(fields : node_t) return node_word_t is
  begin
    return fields.cx & fields.cy & fields.cz & fields.r
      & fields.leaf & fields.count & fields.first;
  end function pack_node;

  function unpack_vertex(word : vertex_word_t) return vertex_t is
    variable fields_v : vertex_t;
  begin
    fields_v.x := word(77 downto 60);
    fields_v.y := word(59 downto 42);
    fields_v.z := word(41 downto 24);
    fields_v.slot := word(23 downto 22);
    fields_v.emit := word(21);
    fields_v.triangle := word(20 downto 0);
    return fields_v;
  end function unpack_vertex;

  function pack_vertex(fields : vertex_t) return vertex_word_t is
  begin
    return fields.x & fields.y & fields.z & fields.slot
      & fields.emit & fields.triangle;
  end function pack_vertex;

  function unpack_fixed_plane(word : fixed_plane_word_t) return fixed_plane_t is
    variable fields_v : fixed_plane_t;
  begin
    fields_v.nx := word(89 downto 72);
    fields_v.ny := word(71 downto 54);
    fields_v.nz := word(53 downto 36);
    fields_v.p := word(35 downto 0);
    return fields_v;
  end function unpack_fixed_plane;

  function pack_fixed_plane(fields : fixed_plane_t) return fixed_plane_word_t is
  begin
    return fields.nx & fields.ny & fields.nz & fields.p;
  end function pack_fixed_plane;

  function unpack_limits(word : limits_word_t) return limits_t is
    variable fields_v : limits_t;
  begin
    fields_v.band := word(69 downto 46);
    fields_v.any_hit := word(45);
    fields_v.scale := word(44 downto 40);
    fields_v.least := word(39 downto 35);
    fields_v.error := word(34 downto 33);
    fields_v.slack := word(32 downto 15);
    fields_v.far := word(14 downto 0);
    return fields_v;
  end function unpack_limits;

  function pack_limits(fields : limits_t) return limits_word_t is
  begin
    return fields.band & fields.any_hit & fields.scale & fields.least
      & fields.error & fields.slack & fields.far;
  end function pack_limits;

end package body raplas_constants;
