// Checks where the points of a store's nodes lie.
#pragma once

#include <gtest/gtest.h>

#include "palpate/geometry/point_store.hpp"

namespace palpate::test {

/// The points of each node lie in its cube.
inline void expect_in_cubes(const PointStore& store) {
  ASSERT_FALSE(store.layout().nodes.empty());
  for (std::size_t k = 0; k < store.layout().nodes.size(); ++k) {
    Box box = store.layout().box(k);
    box.lower.array() -= 1e-3;  // coordinates are rounded
    box.upper.array() += 1e-3;
    const PointCloud node = store.read(k);
    for (std::size_t i = 0; i < node.size(); ++i) ASSERT_TRUE(box.contains(node.point(i)));
  }
}

}  // namespace palpate::test
