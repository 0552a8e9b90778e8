#include <gtest/gtest.h>

#include <random>

#include "viewer/messages.hpp"

namespace palpate::viewer {
namespace {

template <class T>
T read(const std::string& text) {
  const ClientMessage message = read_message(text);
  if (const T* read = std::get_if<T>(&message)) return *read;
  const auto* unread = std::get_if<Unreadable>(&message);
  ADD_FAILURE() << text << ": " << (unread != nullptr ? unread->text : "another message");
  return {};
}

std::string refusal(const std::string& text) {
  const ClientMessage message = read_message(text);
  const auto* unread = std::get_if<Unreadable>(&message);
  return unread != nullptr ? unread->text : "";
}

TEST(ClientMessage, EveryKindOfTheProtocolIsRead) {
  EXPECT_EQ(read<Hello>(R"({"type":"hello","token":"ab","points":5000})").token, "ab");
  EXPECT_EQ(read<Hello>(R"({"type":"hello","token":"ab","points":5000})").points, 5000u);
  const Hand hand =
      read<Hand>(R"({"type":"hand","device":1,"position":[0.1,-2,3e-3],"buttons":4294967295})");
  EXPECT_EQ(hand.device, 1u);
  EXPECT_EQ(hand.target.position, Eigen::Vector3d(0.1, -2, 3e-3));
  EXPECT_EQ(hand.target.buttons, 4294967295u);
  EXPECT_EQ(hand.target.orientation.coeffs(), Eigen::Vector4d(0, 0, 0, 1));
  const Hand turned = read<Hand>(R"({"type":"hand","device":1,"position":[0,0,0],"buttons":0,)"
                                 R"("orientation":[0.6,0,0,0.8],"opening":0.02})");
  EXPECT_TRUE(turned.target.orientation.coeffs().isApprox(Eigen::Vector4d(0.6, 0, 0, 0.8), 1e-12));
  EXPECT_EQ(turned.target.opening, 0.02);
  EXPECT_FALSE(turned.eye);
  const Hand led = read<Hand>(
      R"({"type":"hand","device":1,"position":[0,0,0],"eye":[1,2,-3],"buttons":0,"force":2})");
  EXPECT_EQ(led.eye, Eigen::Vector3d(1, 2, -3));
  EXPECT_EQ(led.target.maximum_force, 2);
  EXPECT_EQ(read<Release>(R"({"type":"release","device":2})").device, 2u);
  EXPECT_EQ(std::get<double>(read<Set>(R"({"type":"set","key":"k","value":-1.5})").value), -1.5);
  EXPECT_EQ(std::get<bool>(read<Set>(R"({"type":"set","key":"k","value":true})").value), true);
  EXPECT_EQ(std::get<std::string>(read<Set>(R"({"type":"set","key":"k","value":"a"})").value), "a");
  EXPECT_EQ(read<Preset>(R"({"type":"preset","name":"wood"})").name, "wood");
  EXPECT_TRUE(read<Pause>(R"({"type":"pause","on":true})").on);
  read<Reset>(R"({"type":"reset"})");
  EXPECT_FALSE(read<Record>(R"({"type":"record","on":false})").on);
  EXPECT_EQ(read<Seek>(R"({"type":"seek","time":2.5})").time, 2.5);
  EXPECT_EQ(read<Play>(R"({"type":"play","on":true,"speed":4})").speed, 4);
  EXPECT_EQ(read<Points>(R"({"type":"points","points":0})").points, 0u);
  EXPECT_EQ(read<Ping>(R"({"type":"ping","id":9007199254740992})").id, 9007199254740992.0);
}

TEST(ClientMessage, WhatCannotBeReadIsRefusedWithWords) {
  for (const char* text : {
           "",
           " ",
           "{",
           "[]",
           "null",
           "true",
           "17",
           "\"hello\"",
           "{}",
           R"({"type":7})",
           R"({"type":"hand"})",
           R"({"type":"nothing"})",
           R"({"type":"hello","token":"a"})",
           R"({"type":"hello","token":1,"points":1})",
           R"({"type":"hello","token":"a","points":-1})",
           R"({"type":"hello","token":"a","points":1.5})",
           R"({"type":"hello","token":"a","points":1e9})",
           R"({"type":"hand","device":0,"position":[0,0],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,0],"eye":[0,0],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,0],"eye":[0,0,1e7],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,"0"],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,null],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,1e999],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,1e7],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,NaN],"buttons":0})",
           R"({"type":"hand","device":256,"position":[0,0,0],"buttons":0})",
           R"({"type":"hand","device":-1,"position":[0,0,0],"buttons":0})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":4294967296})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"orientation":[0,0,0,0]})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"orientation":[0,0,1]})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"orientation":[1,0,0,1]})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"orientation":[0,0,0,"1"]})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"opening":-0.01})",
           R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0,"opening":11})",
           R"({"type":"pause","on":1})",
           R"({"type":"set","key":"k"})",
           R"({"type":"set","key":"k","value":null})",
           R"({"type":"set","key":"k","value":[1]})",
           R"({"type":"set","key":3,"value":1})",
           R"({"type":"ping","id":"x"})",
           R"({"type":"reset"} trailing)",
           "{\"type\":\"reset\"",
           "\xff\xfe",
           "{\"type\":\"\xff\"}",
       }) {
    EXPECT_FALSE(refusal(text).empty()) << text;
  }
}

TEST(ClientMessage, LongAndDeepTextsAreRefused) {
  EXPECT_FALSE(refusal(R"({"type":"preset","name":")" + std::string(300, 'a') + "\"}").empty());
  EXPECT_FALSE(refusal(std::string(60'000, '[')).empty());
  EXPECT_FALSE(refusal(std::string(30'000, '[') + std::string(30'000, ']')).empty());
  std::string nested = R"({"type":"set","key":"k","value":)";
  nested += std::string(20'000, '[') + std::string(20'000, ']') + "}";
  EXPECT_FALSE(refusal(nested).empty());
}

TEST(ClientMessage, DamagedMessagesNeverThrow) {
  const std::string whole =
      R"({"type":"hand","device":1,"position":[0.1,-2,3e-3],"buttons":3,"key":"a","value":true})";
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = whole;
    for (int k = 0; k <= i % 4; ++k) text[place(random)] = static_cast<char>(byte(random));
    EXPECT_NO_THROW((void)read_message(text)) << text;
  }
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(refusal(whole.substr(0, size)).empty());
  }
}

}  // namespace
}  // namespace palpate::viewer
