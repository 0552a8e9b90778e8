#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "io/formats.hpp"

namespace palpate::io {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> result;
  for (const int v : values) result.push_back(static_cast<std::byte>(v));
  return result;
}

TEST(Lzf, CopiesLiteralsAndRepeats) {
  std::vector<std::byte> out(3 + 4 + 9 + 1);
  // "abc"; 4 from 3 back; 9 from 1 back (a run); "z"
  const auto packed = bytes({2, 'a', 'b', 'c', 2 << 5, 2, 7 << 5, 0, 0, 0, 'z'});
  EXPECT_FALSE(lzf_unpack(packed, out));
  std::string text;
  for (const std::byte b : out) text += static_cast<char>(b);
  EXPECT_EQ(text, "abcabca" + std::string(9, 'a') + "z");
}

TEST(Lzf, ReachesFarBackWithTheLowFiveBits) {
  std::vector<std::byte> packed;
  for (int i = 0; i < 9; ++i) {
    packed.push_back(std::byte{31});
    for (int k = 0; k < 32; ++k) packed.push_back(static_cast<std::byte>(i * 32 + k));
  }
  packed.push_back(std::byte{(1 << 5) | 1});  // 3 from 256 + 31 + 1 = 288 back: the very start
  packed.push_back(std::byte{31});
  std::vector<std::byte> out(9 * 32 + 3);
  EXPECT_FALSE(lzf_unpack(packed, out));
  EXPECT_EQ(out[288], std::byte{0});
  EXPECT_EQ(out[290], std::byte{2});
}

TEST(Lzf, RefusesWhatLeavesTheBuffers) {
  std::vector<std::byte> out(4);
  EXPECT_EQ(lzf_unpack(bytes({3, 'a'}), out), 0u);             // too few literals
  EXPECT_EQ(lzf_unpack(bytes({4, 1, 2, 3, 4, 5}), out), 0u);   // too long
  EXPECT_EQ(lzf_unpack(bytes({0, 'a', 1 << 5, 1}), out), 2u);  // before the start
  EXPECT_EQ(lzf_unpack(bytes({0, 'a', 3 << 5, 0}), out), 2u);  // past the end
  EXPECT_EQ(lzf_unpack(bytes({0, 'a', 7 << 5}), out), 2u);     // cut
  EXPECT_EQ(lzf_unpack(bytes({0, 'a'}), out), 2u);             // leaves a hole
  EXPECT_EQ(lzf_unpack({}, out), 0u);
}

}  // namespace
}  // namespace palpate::io
