// Reports how far some work is.
#pragma once

#include <functional>
#include <utility>

namespace palpate::detail {

/// Takes the share of some work that is done, 0 to 1; may throw, which ends the work. Empty: nobody
/// waits for it.
using Progress = std::function<void(double share)>;

inline void tell(const Progress& progress, double share) {
  if (progress) progress(share);
}

/// For a part of the work, which is done between these shares of the whole.
[[nodiscard]] inline Progress part(Progress whole, double from, double to) {
  if (!whole) return {};
  return [whole = std::move(whole), from, to](double share) { whole(from + share * (to - from)); };
}

}  // namespace palpate::detail
