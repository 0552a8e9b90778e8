#pragma once

#include <string>

namespace palpate::app {

/// The person's browser, opened at an address that others of the machine must not learn: it is in
/// no command line, but in a file that the person alone may read and that leads there. Removed at
/// the end.
class Browser {
 public:
  /// Opens nothing where there is no browser, no desktop or no place for the file.
  explicit Browser(const std::string& url);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

 private:
  std::string file_;
};

}  // namespace palpate::app
