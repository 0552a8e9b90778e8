#pragma once

#include <string>

#include "apps/palpate/doctor/checks.hpp"
#include "support/folder.hpp"

namespace palpate::app::doctor {

/// A machine that exists in a folder. As made it is bare, like a container with nothing mounted:
/// no files, no rights, no library, no device.
class MadeUp {
 public:
  MadeUp();

  /// A file under its root, with its folders.
  void file(const std::string& path, const std::string& text) { root_.write(path, text + "\n"); }
  /// Something on USB, with its node; one interface, held by `driver` unless that is empty.
  void usb(const std::string& place, const std::string& vendor, const std::string& product, int bus,
           int number, const std::string& driver = "", const std::string& title = "");
  /// A serial port of what is plugged in at `place`.
  void terminal(const std::string& place, const std::string& name);
  /// Where nothing is wrong: real-time kernel and rights, tsc, performance, palpate's files, a
  /// desktop with browser and pictures.
  void make_healthy();

  System system;

 private:
  test::Folder root_;
};

/// What was found on something; it is an error of the test when there is no such finding.
[[nodiscard]] Finding about(const std::string& looked_at, const Findings& findings);

}  // namespace palpate::app::doctor
