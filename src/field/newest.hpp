#pragma once

namespace palpate {

/// A column of surface points as it is at the end of their way: that of the start where it does not
/// change.
template <class Column>
[[nodiscard]] const Column& newest(const Column& start, const Column& end) {
  return end.empty() ? start : end;
}

}  // namespace palpate
