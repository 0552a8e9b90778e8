// Declares how the packets of an E57 scan become columns of numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/e57/contents.hpp"
#include "io/e57/pages.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// The numbers of one column, from a stream of bits that runs on from packet to packet.
class E57Column {
 public:
  explicit E57Column(const E57Field& field);

  void append(std::span<const std::byte> bytes);

  /// Numbers that have arrived whole and were not taken; a column of no bits never ends.
  [[nodiscard]] std::uint64_t available() const;

  /// Makes the next `count` of them values().
  void take(std::size_t count);

  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  [[nodiscard]] std::uint64_t bits_at(std::uint64_t bit) const;
  [[nodiscard]] double number(std::uint64_t bits) const;

  E57Field field_;
  std::vector<std::byte> bytes_;  // with kSlack zeros behind them
  std::uint64_t next_ = 0;        // bit of the next number
  std::vector<double> values_;
};

/// Reads the points of a scan packet by packet. Columns may come unevenly: a packet holds whatever
/// bytes of each its writer had.
class E57Packets {
 public:
  /// `used`: the scan's fields that are wanted, by rising index. All arguments must outlive this
  /// but `used`. The time for a point or a packet depends on these fields alone, not on how many
  /// the XML lists.
  /// @throws Error unless there are points of that size where the scan declares them.
  E57Packets(const Input& input, E57Pages& pages, const E57Scan& scan,
             const std::vector<std::size_t>& used);

  /// Bytes of the scan's points, with their packets.
  [[nodiscard]] std::uint64_t bytes() const { return end_ - scan_.section; }

  /// Decodes some of the next points; 0 when all are done. @throws Error when packets are damaged
  /// or missing.
  [[nodiscard]] std::size_t next();

  /// The numbers of the field `used[column]`, of the points of the last next().
  [[nodiscard]] const std::vector<double>& values(std::size_t column) const {
    return columns_[column].values();
  }

 private:
  void check_room() const;
  void read_packet();
  void split_packet();
  [[nodiscard]] std::size_t take();

  const Input& input_;
  E57Pages& pages_;
  const E57Scan& scan_;
  std::vector<std::size_t> used_;   // fields
  std::vector<E57Column> columns_;  // one for each used field
  std::uint64_t offset_ = 0;        // of the next packet
  std::uint64_t end_ = 0;           // of the section
  std::uint64_t done_ = 0;          // points
  std::vector<std::byte> packet_;
};

}  // namespace palpate::io
