#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "any_cloud/score.hpp"

namespace palpate::any_cloud {

/// What scenes are like without one refinement, each beside the same scene with all of them. A
/// scene is worse where more pokes pass and hands are held, together, or where a step of force
/// becomes larger than 1 N.
struct Price {
  std::string refinement;
  int scenes = 0;     ///< that both prepare
  int differ = 0;     ///< in any number of the score but times
  int worse = 0;      ///< without it
  int better = 0;     ///< without it
  double passed = 0;  ///< more pokes, in all
  double held = 0;    ///< more hands, in all
};

/// Leaves out each refinement in turn. `done`: called after each scene.
[[nodiscard]] std::vector<Price> ablate(const std::vector<Row>& rows, std::uint64_t first_seed,
                                        int seeds, const FieldOptions& field,
                                        const std::function<void()>& done = {});

/// How likely so uneven a split of worse and better scenes is by chance: a two-sided sign test.
[[nodiscard]] double sign_test(int worse, int better);

/// The prices as lines of a table in Markdown.
[[nodiscard]] std::string price_table(const std::vector<Price>& prices);

}  // namespace palpate::any_cloud
