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
  -- bits of a sphere or triangle ID (the address in its memory)
  constant ID_BITS : natural := 20;
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

  subtype fp24_t is std_ulogic_vector(FP_BITS - 1 downto 0);

  -- node of the sphere tree; children first .. first+count-1: triangles in a leaf, else spheres
  constant SPHERE_BITS : natural := 124;
  subtype sphere_word_t is std_ulogic_vector(123 downto 0);
  type sphere_t is record
    cx : fp24_t;
    cy : fp24_t;
    cz : fp24_t;
    r : fp24_t;
    leaf : std_ulogic;
    count : std_ulogic_vector(6 downto 0);
    first : std_ulogic_vector(19 downto 0);
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

  -- unit direction; address = bank * 256 + ray ID
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
  constant SCENE_BITS : natural := 62;
  subtype scene_word_t is std_ulogic_vector(61 downto 0);
  type scene_t is record
    spheres : std_ulogic_vector(20 downto 0);
    count : std_ulogic_vector(20 downto 0);
    first : std_ulogic_vector(19 downto 0);
  end record;
  function unpack_scene(word : scene_word_t) return scene_t;
  function pack_scene(fields : scene_t) return scene_word_t;

  -- nearest hit of a ray: t = t'/d, u = u'/d, v = v'/d; address = bank * 256 + ray ID
  constant RESULT_BITS : natural := 117;
  subtype result_word_t is std_ulogic_vector(116 downto 0);
  type result_t is record
    hit : std_ulogic;
    triangle : std_ulogic_vector(19 downto 0);
    t : fp24_t;
    d : fp24_t;
    u : fp24_t;
    v : fp24_t;
  end record;
  function unpack_result(word : result_word_t) return result_t;
  function pack_result(fields : result_t) return result_word_t;

  -- codes of the host's write targets
  constant TARGET_SPHERE : natural := 0;
  constant TARGET_TRIANGLE : natural := 1;
  constant TARGET_PLANE : natural := 2;
  constant TARGET_RAY : natural := 3;
  constant TARGET_PENCIL : natural := 4;
  constant TARGET_SCENE : natural := 5;

  -- places of the counters in the counter bus, COUNTER_BITS each
  constant COUNTER_CYCLES : natural := 0;
  constant COUNTER_SPHERES_TESTED : natural := 1;
  constant COUNTER_SPHERES_SKIPPED : natural := 2;
  constant COUNTER_PLANE_TESTS : natural := 3;
  constant COUNTER_PAIRS_TESTED : natural := 4;
  constant COUNTER_HITS : natural := 5;
  constant COUNTER_STALL_CYCLES : natural := 6;
  constant NUM_COUNTERS : natural := 7;

end package raplas_constants;

package body raplas_constants is

  function unpack_sphere(word : sphere_word_t) return sphere_t is
    variable fields_v : sphere_t;
  begin
    fields_v.cx := word(123 downto 100);
    fields_v.cy := word(99 downto 76);
    fields_v.cz := word(75 downto 52);
    fields_v.r := word(51 downto 28);
    fields_v.leaf := word(27);
    fields_v.count := word(26 downto 20);
    fields_v.first := word(19 downto 0);
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
    fields_v.spheres := word(61 downto 41);
    fields_v.count := word(40 downto 20);
    fields_v.first := word(19 downto 0);
    return fields_v;
  end function unpack_scene;

  function pack_scene(fields : scene_t) return scene_word_t is
  begin
    return fields.spheres & fields.count & fields.first;
  end function pack_scene;

  function unpack_result(word : result_word_t) return result_t is
    variable fields_v : result_t;
  begin
    fields_v.hit := word(116);
    fields_v.triangle := word(115 downto 96);
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

end package body raplas_constants;
