#include "configuration_list.hpp"

#ifdef RAPLAS_WITH_EMBREE
#include "embree_device.hpp"
#endif
#include "reference_device.hpp"

namespace raplas {
namespace {

constexpr int kPaperPencil = 4;

/// Entity intersection_unit with numbers of format F.
template <typename F>
Configuration unit(const char* name, const char* title, Structure structure, int pencil, Testers testers,
                   const char* netlist) {
  return {name,
          title,
          structure,
          pencil,
          [] { return std::make_unique<UnitDevice<F>>(); },
          [testers](const DeviceScene& scene, std::span<const Pencil> pencils) {
            return unit_clocks<F>(scene, testers, pencils);
          },
          netlist};
}

/// The clocked model of entity raplas_unit.
Configuration raplas_unit(const char* name, const char* title, const DeviceOptions& options,
                          const char* netlist) {
  const auto make = [options] { return make_device("model", options); };
  return {name, title, Structure::tree, kMaxRows, make, {}, netlist};
}

Configuration software(const char* name, const char* title,
                       std::function<std::unique_ptr<IntersectionDevice>()> make) {
  return {name, title, Structure::tree, kMaxRows, std::move(make)};
}

#ifdef RAPLAS_WITH_EMBREE
constexpr bool kWithEmbree = true;
#else
constexpr bool kWithEmbree = false;
#endif

}  // namespace

bool with_embree() { return kWithEmbree; }

std::vector<Configuration> configurations() {
  constexpr auto kFlat = Structure::flat;
  constexpr auto kTree = Structure::whole_tree;
  std::vector<Configuration> list{
      software("double", "software, double precision", [] { return make_device("reference", {}); }),
      software("float", "software, single precision",
               [] { return std::make_unique<ReferenceDevice<float>>(); }),
#ifdef RAPLAS_WITH_EMBREE
      software("embree", "Embree", [] { return make_embree_device(false); }),
      software("embree_robust", "Embree, robust", [] { return make_embree_device(true); }),
#endif
      unit<Fp24Paper>("paper", "profile paper: flat list, no guard bits, 4+4 testers", kFlat, kPaperPencil,
                      {4, 4}, "intersection_unit_paper"),
      unit<Fp24>("paper_guarded", "paper with exact adders", kFlat, kPaperPencil, {4, 4},
                 "intersection_unit"),
      unit<Fp24Paper>("paper_tree", "paper with a tree", kTree, kMaxRows, {4, 4}, "intersection_unit_paper"),
      unit<Fp24>("tree_2x2", "exact adders, a tree, 2+2 testers", kTree, kMaxRows, {2, 2},
                 "intersection_unit_2x2"),
      raplas_unit("raplas", "profile raplas", {}, "raplas_unit"),
      raplas_unit("exact", "profile raplas, exact", {.exact = true}, "raplas_unit"),
  };
  return list;
}

}  // namespace raplas
