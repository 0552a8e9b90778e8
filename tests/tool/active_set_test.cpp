// The least motion under constraints against brute force, which tries every set of active ones.
#include "tool/active_set.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <optional>
#include <vector>

#include "base/numbers.hpp"
#include "support/effort.hpp"

namespace palpate::test {
namespace {

constexpr double kTolerance = 1e-11;  // m, that the proxy's solver works with

struct Problem {
  std::vector<Constraint> constraints;
  Motion wanted = Motion::Zero();
};

/// Does the motion keep all constraints, as well as the solver has to? What is left open here,
/// times the inverse of the angle between constraints, is how far answers may be apart.
bool is_allowed(const Problem& problem, const Motion& motion) {
  for (const Constraint& each : problem.constraints) {
    if (each.normal.dot(motion) < each.bound - 2 * kTolerance) return false;
  }
  return true;
}

/// The motion on which the constraints of a set hold with equality, if the set can be active.
std::optional<Motion> motion_on(const Problem& problem, const std::vector<int>& set) {
  Motion motion = problem.wanted;
  if (!set.empty()) {
    Eigen::MatrixXd normals(kFreedoms, static_cast<Eigen::Index>(set.size()));
    Eigen::VectorXd lacking(normals.cols());
    for (Eigen::Index k = 0; k < normals.cols(); ++k) {
      const int index = set[static_cast<std::size_t>(k)];
      const Constraint& each = problem.constraints[static_cast<std::size_t>(index)];
      normals.col(k) = each.normal;
      lacking[k] = each.bound - each.normal.dot(problem.wanted);
    }
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> rows(normals.transpose());
    if (rows.rank() < normals.cols()) return std::nullopt;
    const Motion pushed = rows.solve(lacking);  // the shortest
    const Eigen::VectorXd multipliers = normals.colPivHouseholderQr().solve(pushed);
    if (multipliers.minCoeff() < -1e-9) return std::nullopt;
    motion += pushed;
  }
  if (!is_allowed(problem, motion)) return std::nullopt;
  return motion;
}

void try_sets(const Problem& problem, std::vector<int>& set, std::optional<Motion>& best) {
  if (const std::optional<Motion> found = motion_on(problem, set)) {
    const double length = (*found - problem.wanted).norm();
    if (!best || length < (*best - problem.wanted).norm()) best = found;
  }
  if (set.size() == kFreedoms) return;
  const int next = set.empty() ? 0 : set.back() + 1;
  for (int i = next; i < static_cast<int>(problem.constraints.size()); ++i) {
    set.push_back(i);
    try_sets(problem, set, best);
    set.pop_back();
  }
}

/// The closest allowed motion; empty where none is allowed.
std::optional<Motion> by_brute_force(const Problem& problem) {
  std::optional<Motion> best;
  std::vector<int> set;
  try_sets(problem, set, best);
  return best;
}

Motion random_motion(Random& random, int freedoms) {
  Motion motion = Motion::Zero();
  for (int i = 0; i < freedoms; ++i) motion[i] = random.normal();
  return motion;
}

Problem random_problem(Random& random, int rows, int freedoms) {
  Problem problem;
  problem.wanted = random_motion(random, kFreedoms);
  for (int i = 0; i < rows; ++i) {
    Constraint each;
    each.normal = random_motion(random, freedoms);
    each.bound = 0.5 * random.normal();
    problem.constraints.push_back(each);
  }
  return problem;
}

/// The wanted motion and what pushes, added up, are the answer; nothing pulls, all is active.
void expect_balanced(const Problem& problem, const LeastMotion& answer) {
  Motion sum = problem.wanted;
  double largest = 1;
  for (int k = 0; k < answer.count; ++k) {
    const ActiveConstraint& active = answer.active[static_cast<std::size_t>(k)];
    const Constraint& each = problem.constraints[static_cast<std::size_t>(active.index)];
    EXPECT_GE(active.multiplier, 0);
    EXPECT_NEAR(each.normal.dot(answer.motion), each.bound, 1e-9);
    largest = std::max(largest, active.multiplier);
    sum += active.multiplier * each.normal;
  }
  EXPECT_LT((sum - answer.motion).norm(), 1e-9 * largest);
}

/// True if the problem was solved; where brute force finds no motion, the solver must not either.
bool expect_as_brute_force(const Problem& problem) {
  const LeastMotion answer = least_motion(problem.constraints, problem.wanted, kTolerance);
  const std::optional<Motion> truth = by_brute_force(problem);
  EXPECT_EQ(answer.end == LeastMotion::End::solved, truth.has_value());
  EXPECT_LE(answer.iterations, kSolverIterations);
  if (!truth || answer.end != LeastMotion::End::solved) return false;
  EXPECT_LT((answer.motion - *truth).norm(), 1e-8 * (1 + truth->norm()));
  expect_balanced(problem, answer);
  return true;
}

TEST(ActiveSet, IsTheClosestMotionThatBruteForceFinds) {
  Random random(1);
  int solved = 0;
  const int count = effort(2000);
  for (int i = 0; i < count; ++i) {
    solved += expect_as_brute_force(random_problem(random, 1 + i % 9, kFreedoms)) ? 1 : 0;
  }
  EXPECT_GT(solved, count / 2);
}

TEST(ActiveSet, SaysWhereNothingIsAllowed) {
  Random random(2);
  int solved = 0;
  const int count = effort(2000);
  for (int i = 0; i < count; ++i) {
    solved += expect_as_brute_force(random_problem(random, 3 + i % 7, 1 + i % 3)) ? 1 : 0;
  }
  EXPECT_GT(solved, count / 10);
  EXPECT_LT(solved, count - count / 10);
}

TEST(ActiveSet, TakesDuplicateAndScaledConstraintsForOne) {
  Random random(3);
  int solved = 0;
  for (int i = 0; i < effort(500); ++i) {
    Problem problem = random_problem(random, 4, kFreedoms);
    Constraint scaled = problem.constraints[1];
    scaled.normal *= 3;
    scaled.bound *= 3;
    problem.constraints.push_back(problem.constraints[0]);
    problem.constraints.push_back(scaled);
    solved += expect_as_brute_force(problem) ? 1 : 0;
  }
  EXPECT_GT(solved, 0);
}

// Many more constraints than freedoms meet in one motion, as the samples of a flat face do.
TEST(ActiveSet, SolvesDegenerateCorners) {
  Random random(4);
  int solved = 0;
  for (int i = 0; i < effort(500); ++i) {
    const int freedoms = 2 + i % 4;
    Problem problem = random_problem(random, 9, freedoms);
    const Motion corner = random_motion(random, kFreedoms);
    const Motion inward = random_motion(random, freedoms);
    for (Constraint& each : problem.constraints) {
      if (each.normal.dot(inward) < 0) each.normal = -each.normal;
      each.bound = each.normal.dot(corner);
    }
    solved += expect_as_brute_force(problem) ? 1 : 0;
  }
  EXPECT_EQ(solved, effort(500));
}

TEST(ActiveSet, LeavesAnAllowedMotionAsItIs) {
  Random random(5);
  Problem problem = random_problem(random, 9, kFreedoms);
  for (Constraint& each : problem.constraints) each.bound = each.normal.dot(problem.wanted) - 1e-3;
  const LeastMotion answer = least_motion(problem.constraints, problem.wanted, kTolerance);
  EXPECT_EQ(answer.end, LeastMotion::End::solved);
  EXPECT_EQ(answer.motion, problem.wanted);
  EXPECT_EQ(answer.count, 0);
}

TEST(ActiveSet, KnowsThatNothingMovesAConstraintWithoutANormal) {
  std::vector<Constraint> constraints(1);
  constraints[0].bound = -1e-3;
  const Motion wanted = Motion::Ones();
  EXPECT_EQ(least_motion(constraints, wanted, kTolerance).motion, wanted);
  constraints[0].bound = 1e-3;
  EXPECT_EQ(least_motion(constraints, wanted, kTolerance).end, LeastMotion::End::infeasible);
}

// Half a thousand tangent planes of a ball, from far outside: the answer lies on all that it needs
// to and breaks none.
TEST(ActiveSet, SolvesHundredsOfConstraintsWithinItsIterations) {
  Random random(6);
  int solved = 0;
  const int count = effort(100);
  for (int i = 0; i < count; ++i) {
    Problem problem = random_problem(random, 512, 6);
    for (Constraint& each : problem.constraints) {
      each.normal.normalize();
      each.bound = -1;
    }
    problem.wanted = 4 * problem.wanted.normalized();
    const LeastMotion answer = least_motion(problem.constraints, problem.wanted, kTolerance);
    EXPECT_NE(answer.end, LeastMotion::End::infeasible);
    EXPECT_TRUE(is_allowed(problem, answer.motion));
    if (answer.end != LeastMotion::End::solved) continue;
    ++solved;
    expect_balanced(problem, answer);
  }
  EXPECT_GE(solved, count - 1);
  RecordProperty("solved", solved);
}

// Opposed but for rounding: what is called solved is allowed, and a motion across both is not.
TEST(ActiveSet, KeepsBetweenNormalsThatAreNearlyOpposed) {
  Random random(8);
  int solved = 0;
  const int count = effort(2000);
  for (int i = 0; i < count; ++i) {
    Problem problem = random_problem(random, 2, kFreedoms);
    Constraint& one = problem.constraints[0];
    Constraint& other = problem.constraints[1];
    one.normal.normalize();
    other.normal = -one.normal + std::pow(10.0, -4 - i % 12) * random_motion(random, kFreedoms);
    one.bound = i % 3 == 0 ? 0 : -1e-3 * random.uniform();
    other.bound = i % 2 == 0 ? 0 : -1e-3 * random.uniform();
    const LeastMotion answer = least_motion(problem.constraints, problem.wanted, kTolerance);
    if (answer.end != LeastMotion::End::solved) continue;
    ++solved;
    EXPECT_TRUE(is_allowed(problem, answer.motion));
    EXPECT_LT(std::abs(one.normal.dot(answer.motion)), 0.1 * (1 + answer.motion.norm()));
  }
  EXPECT_GT(solved, count / 2);
}

// A motion of zero is allowed, so a part of what was reached is.
TEST(ActiveSet, GoesNoFartherThanAllowedWhenIterationsRunOut) {
  Random random(7);
  int cut_off = 0;
  int moved = 0;
  const int count = effort(500);
  for (int i = 0; i < count; ++i) {
    Problem problem = random_problem(random, 100, kFreedoms);
    for (Constraint& each : problem.constraints) each.bound = -std::abs(each.bound);
    const LeastMotion answer = least_motion(problem.constraints, problem.wanted, kTolerance, 3);
    cut_off += answer.end == LeastMotion::End::cut_off ? 1 : 0;
    moved += answer.motion.norm() > 0 ? 1 : 0;
    EXPECT_LE(answer.iterations, 4);
    EXPECT_TRUE(is_allowed(problem, answer.motion));
  }
  EXPECT_GT(cut_off, 0);
  EXPECT_EQ(moved, count);
}

}  // namespace
}  // namespace palpate::test
