// Normals of the file replace fitted ones where both agree.
#include "prepare/given_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/clouds.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

Vector3f leaning(float degrees) {
  const float angle = degrees * std::numbers::pi_v<float> / 180;
  return Vector3f(std::sin(angle), 0, std::cos(angle)).normalized();
}

class GivenNormals : public testing::Test {
 protected:
  [[nodiscard]] std::vector<Vector3f> taken(const std::vector<Vector3f>& given) const {
    std::vector<Vector3f> normals = fitted_;
    take_given_normals(grid_, given, normals);
    return normals;
  }
  [[nodiscard]] std::vector<Vector3f> all(const Vector3f& normal) const {
    return std::vector<Vector3f>(grid_.size(), normal);
  }

  GivenNormals() {
    for (std::size_t i = 0; i < grid_.size(); ++i) fitted_.push_back(leaning(i % 2 == 0 ? 1 : -1));
  }

  CellGrid grid_{test::Clouds().plane(20, 1)};
  std::vector<Vector3f> fitted_;
};

TEST_F(GivenNormals, AreTakenWithin20Degrees) {
  EXPECT_EQ(taken(all(leaning(15))), all(leaning(15)));
  EXPECT_EQ(taken(all(leaning(25))), fitted_);
}

TEST_F(GivenNormals, KeepTheFittedSignAndBecomeUnit) {
  const std::vector<Vector3f> normals = taken(all(-3 * leaning(10)));
  ASSERT_EQ(normals.size(), grid_.size());
  for (const Vector3f& normal : normals) EXPECT_LT((normal - leaning(10)).norm(), 1e-6f);
}

TEST_F(GivenNormals, ThatAreMissingLeaveFittedOnes) {
  std::vector<Vector3f> given = all(leaning(10));
  given[7].setZero();
  given[8].setConstant(NAN);
  const std::vector<Vector3f> normals = taken(given);
  EXPECT_EQ(normals[7], fitted_[7]);
  EXPECT_EQ(normals[8], fitted_[8]);
  EXPECT_EQ(normals[9], leaning(10));
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (i % 5 != 0) given[i].setZero();
  }
  EXPECT_EQ(taken(given), fitted_) << "a fifth is as good as none";
}

TEST_F(GivenNormals, ThatVaryMoreThanFittedOnesAreLeft) {
  std::vector<Vector3f> given;
  for (std::size_t i = 0; i < grid_.size(); ++i) given.push_back(leaning(i % 2 == 0 ? 10 : -10));
  EXPECT_EQ(taken(given), fitted_);
}

}  // namespace
}  // namespace palpate
