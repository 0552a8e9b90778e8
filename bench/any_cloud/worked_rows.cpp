// Rows of bodies as machines and nature work them: reliefs, threads, combs, lattices.
#include <fmt/format.h>

#include "any_cloud/bodies.hpp"
#include "any_cloud/rows.hpp"
#include "any_cloud/tour.hpp"
#include "any_cloud/worked_shapes.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

void touch_body(Draft& draft, const Body& body) {
  scan(draft, body);
  poke_around(draft);
}

Body draw_relief(double wavelength) {
  const double height = 0.2 * wavelength;
  return {relief({16, 16, 7}, wavelength, height), Vector3d(17, 17, 8 + height)};
}

Body draw_thread(Draft& draft) {
  return {thread(draft.between(8, 12), 36, 4, 1), Vector3d(15, 15, 19)};
}

Body draw_comb(Draft& draft) {
  return {comb(3, 6, draft.between(6, 10), 20), Vector3d(18, 11, 11)};
}

Body draw_lattice(Draft& draft) {
  return {lattice(14, draft.between(2, 3), 3), Vector3d::Constant(25)};
}

Body draw_cup(Draft& draft) {
  return {cup(15, draft.between(10, 13)), Vector3d::Constant(16)};
}

Body draw_spring(Draft& draft) {
  return {spring(12, draft.between(2, 3), 10, 3), Vector3d(16, 16, 16)};
}

Body draw_saddle(Draft& draft) {
  return {saddle({18, 18, 9}, draft.between(3, 7)), Vector3d(19, 19, 17)};
}

}  // namespace

void add_worked_rows(std::vector<Row>& rows) {
  for (const int wavelength : {3, 4, 6, 10, 20}) {
    rows.push_back({"worked", fmt::format("relief {}", wavelength),
                    [=](Draft& draft) { touch_body(draft, draw_relief(wavelength)); }});
  }
  const auto add = [&](const char* name, Body (*draw)(Draft&)) {
    rows.push_back({"worked", name, [=](Draft& draft) { touch_body(draft, draw(draft)); }});
  };
  add("thread", draw_thread);
  add("comb", draw_comb);
  add("lattice", draw_lattice);
  add("cup", draw_cup);
  add("spring", draw_spring);
  add("saddle", draw_saddle);
}

}  // namespace palpate::any_cloud
