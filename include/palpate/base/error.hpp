#pragma once

#include <stdexcept>

namespace palpate {

/// Thrown by set-up and I/O, never by anything that a servo step calls. The message states what
/// failed, on what value, and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
