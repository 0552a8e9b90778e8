// Declares a file that grows at its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>

namespace palpate::io::tile {

class OutFile {
 public:
  /// Opens the file, cut to its first `size` bytes; makes it where that is 0.
  /// @throws Error that states why not: a file that is shorter, too.
  OutFile(const std::filesystem::path& path, std::uint64_t size);
  ~OutFile();
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// @throws Error where the disk is full, or writing fails otherwise.
  void append(std::span<const std::byte> bytes);

  /// Brings all of it to the disk.
  void sync() const;

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string name_;
  int descriptor_;
  std::uint64_t size_;
};

/// Writes a whole file of some parts under another name, and then gives it its own.
void write_file(const std::filesystem::path& path,
                std::initializer_list<std::span<const std::byte>> parts);

/// A folder of work that this process alone has, until it ends for whatever reason.
class Locked {
 public:
  /// @throws Error where another process has it.
  explicit Locked(const std::filesystem::path& folder);
  ~Locked();
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  int descriptor_;
};

}  // namespace palpate::io::tile
