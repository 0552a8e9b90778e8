// A point store becomes one cloud, if memory holds it.
#include "io/whole_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

// Nodes of one to so many points; the last has no colours.
class MadeStore final : public PointStore {
 public:
  explicit MadeStore(std::size_t nodes) {
    layout_.format = "made";
    layout_.origin = {1e6, 0, 0};
    for (std::size_t i = 0; i < nodes; ++i) {
      layout_.nodes.push_back({.points = i + 1});
      layout_.points += i + 1;
    }
  }

  [[nodiscard]] const Layout& layout() const override { return layout_; }

  [[nodiscard]] PointCloud read(std::size_t node) const override {
    if (node >= damaged) throw Error("node " + std::to_string(node));
    PointCloud cloud;
    cloud.origin = layout_.origin;
    for (std::size_t i = 0; i <= node; ++i) {
      cloud.positions.emplace_back(static_cast<float>(node), static_cast<float>(i), 0);
      cloud.intensities.push_back(static_cast<float>(node));
      if (node + 1 < layout_.nodes.size()) cloud.colors.push_back({1, 2, 3});
    }
    return cloud;
  }

  std::size_t damaged = ~std::size_t{0};  // nodes from here on

  Layout layout_;
};

CloudFile whole(const PointStore& store) {
  const ReadOptions options;
  return io::read_whole(store, {{}, "made", options});
}

std::string refusal_of(const PointStore& store) {
  try {
    (void)whole(store);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WholeStore, JoinsAllNodesInTheirOrder) {
  const CloudFile file = whole(MadeStore(300));
  EXPECT_EQ(file.format, "made");
  EXPECT_EQ(file.declared, 300u * 301 / 2);
  EXPECT_EQ(file.dropped, 0u);
  EXPECT_EQ(file.cloud.origin.x(), 1e6);
  ASSERT_EQ(file.cloud.size(), file.declared);
  std::size_t at = 0;
  for (std::size_t node = 0; node < 300; ++node) {
    for (std::size_t i = 0; i <= node; ++i, ++at) {
      const Eigen::Vector3f expected(static_cast<float>(node), static_cast<float>(i), 0);
      ASSERT_EQ(file.cloud.positions[at], expected);
      ASSERT_EQ(file.cloud.intensities[at], static_cast<float>(node));
    }
  }
  EXPECT_TRUE(file.cloud.colors.empty()) << "a node has none";
}

TEST(WholeStore, NamesTheFirstNodeThatIsDamaged) {
  MadeStore store(200);
  store.damaged = 70;
  EXPECT_EQ(refusal_of(store), "node 70");
}

TEST(WholeStore, RefusesWhatMemoryCannotHold) {
  const auto many = static_cast<std::size_t>(std::uint64_t{1} << 50U);
  if (many == 0) GTEST_SKIP() << "no count of 32 bits is that large";
  MadeStore store(1);
  store.layout_.points = many;
  EXPECT_THAT(refusal_of(store), HasSubstr("made: holds 1125899906842624 points and would need "
                                           "about 42784196.5 GB of memory; "));
}

TEST(WholeStore, RefusesOneWithoutPoints) {
  EXPECT_THAT(refusal_of(MadeStore(0)), HasSubstr("holds no points"));
}

}  // namespace
}  // namespace palpate
