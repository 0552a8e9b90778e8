// Options in recordings: exact numbers, and choices that are names.
#include "session/options_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "palpate/base/error.hpp"

namespace palpate::session {
namespace {

TEST(OptionsJson, OptionsComeBackAsTheyWere) {
  PrepareOptions prepare;
  prepare.radius = 0.1 + 0.2;
  prepare.orientation = PrepareOptions::Orientation::outward;
  prepare.clip = Box{{0, 0, -1}, {1, 2, 1. / 3}};
  prepare.facts = CloudFacts{};
  ProxyOptions proxy;
  proxy.friction.viscous = 1e-300;
  proxy.rise_time = std::numeric_limits<double>::infinity();
  proxy.method = ProxyOptions::Method::single_step;
  ServoOptions servo{.proxy = proxy};
  servo.guard.passivity.delay = 3;
  const SourceOptions source{.prepare = prepare, .policy = {.policy = Policy::average, .fade = 2}};

  const Json json = {{"servo", exact_json(servo)}, {"source", exact_json(source)}};
  const Json read = Json::parse(json.dump());
  ServoOptions servo_again;
  SourceOptions source_again;
  take_exact(read.at("servo"), servo_again);
  take_exact(read.at("source"), source_again);
  EXPECT_EQ(exact_json(servo_again), exact_json(servo));
  EXPECT_EQ(exact_json(source_again), exact_json(source));
  EXPECT_EQ(source_again.prepare.radius, 0.1 + 0.2);
  EXPECT_EQ(source_again.prepare.clip->upper.z(), 1. / 3);
  EXPECT_EQ(source_again.policy.fade, 2);
  EXPECT_EQ(servo_again.guard.passivity.delay, 3);
  EXPECT_EQ(servo_again.proxy.method, ProxyOptions::Method::single_step);
  EXPECT_EQ(servo_again.proxy.rise_time, std::numeric_limits<double>::infinity());
}

TEST(OptionsJson, AToolComesBackBitForBit) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -3) / 7;
  std::vector<Tool::Point> points;
  for (int i = 0; i < 60; ++i) {
    points.push_back({{0.1 / (i + 1), 0.01 * (i % 7), 1. / 3}, 1e-3 * (i % 2), i % 3 - 1});
  }
  for (const Tool& tool : {Tool::gripper({6e-3, 12e-3, 40e-3}, 3e-3), Tool(points, axis)}) {
    ServoOptions servo{.tool = std::make_shared<const Tool>(tool), .gyration = 0.1 + 0.2};
    const Json json = Json::parse(exact_json(servo).dump());
    ServoOptions again;
    take_exact(json, again);
    ASSERT_TRUE(again.tool);
    EXPECT_EQ(again.gyration, 0.1 + 0.2);
    EXPECT_EQ(again.tool->axis(), tool.axis());
    EXPECT_EQ(again.tool->gyration(), tool.gyration());
    ASSERT_EQ(again.tool->samples().size(), tool.samples().size());
    for (std::size_t i = 0; i < tool.samples().size(); ++i) {
      EXPECT_EQ(again.tool->samples()[i].position, tool.samples()[i].position);
      EXPECT_EQ(again.tool->samples()[i].radius, tool.samples()[i].radius);
      EXPECT_EQ(again.tool->samples()[i].side, tool.samples()[i].side);
    }
  }
  ServoOptions point{.tool = std::make_shared<const Tool>(Tool::ball(1))};
  take_exact(exact_json(ServoOptions()), point);
  EXPECT_FALSE(point.tool);
}

TEST(OptionsJson, WhatIsNoToolIsRefused) {
  for (const char* tool :
       {R"({"axis": [1, 0, 0], "samples": []})", R"({"axis": [0, 0, 0], "samples": [[0,0,0,0,0]]})",
        R"({"axis": [1, 0, 0], "samples": [[0,0,0,0,0.5]]})",
        R"({"axis": [1, 0, 0], "samples": [[0,0,0,-1,0]]})",
        R"({"axis": [1, 0, 0], "samples": [[1e9,0,0,0,0]]})",
        R"({"axis": [1, 0, "x"], "samples": [[0,0,0,0,0]]})",
        R"({"axis": [1, 0, 0], "samples": [[true,0,0,0,0]]})"}) {
    ServoOptions servo;
    EXPECT_THROW(take_exact(Json{{"tool", Json::parse(tool)}}, servo), Error) << tool;
  }
  ServoOptions servo;
  const Json few = Json::parse(R"({"axis": [1, 0, 0], "samples": [[0,0,0]]})");
  EXPECT_THROW(take_exact(Json{{"tool", few}}, servo), Json::exception);
}

TEST(OptionsJson, ChoicesAreNamesAndNumbersOfEarlierVersionsAreRead) {
  EXPECT_EQ(exact_json(PolicyOptions{.policy = Policy::morph}).at("policy"), "morph");
  PolicyOptions options;
  take_exact(Json::parse(R"({"policy": "average"})"), options);
  EXPECT_EQ(options.policy, Policy::average);
  take_exact(Json::parse(R"({"policy": 4})"), options);
  EXPECT_EQ(options.policy, Policy::morph);
  take_exact(Json::parse(R"({"policy": null})"), options);
  EXPECT_FALSE(options.policy);
}

TEST(OptionsJson, ChoicesThatThereAreNotAreRefused) {
  for (const char* json : {R"({"policy": 3})", R"({"policy": "fusion"})", R"({"policy": 1e9})",
                           R"({"policy": true})", R"({"policy": []})"}) {
    PolicyOptions options;
    EXPECT_THROW(take_exact(Json::parse(json), options), Error) << json;
  }
}

TEST(OptionsJson, WhatIsRefusedIsNamedInShortHoweverDeepItIs) {
  const auto words = [](const Json& json) {
    try {
      return std::string(name_in(choices(Policy()), choice_in<Policy>(json)));
    } catch (const Error& error) {
      const std::string text = error.what();
      return text.substr(0, text.find(" is none of"));
    }
  };
  constexpr std::size_t kDeep = 1'000'000;  // calls of a function that are more than a stack holds
  EXPECT_EQ(words(Json::parse(std::string(kDeep, '[') + std::string(kDeep, ']'))), "array");
  EXPECT_EQ(words("fusion"), "\"fusion\"");
  EXPECT_EQ(words(-3), "-3");
  EXPECT_EQ(words(true), "boolean");
  EXPECT_EQ(words(std::string(1000, 'x')), "\"" + std::string(79, 'x') + "...");
  EXPECT_EQ(words("\xff"), "\"\\ufffd\"") << "no UTF-8";
}

/// What the error says of options that are not taken; empty: they are.
template <class Options>
std::string refusal_of(const char* json) {
  Options options;
  try {
    take_exact(Json::parse(json), options);
  } catch (const Error& error) {
    return error.what();
  } catch (const Json::exception& error) {
    return error.what();
  }
  return {};
}

TEST(OptionsJson, WhatIsNoNumberIsRefusedAndNamed) {
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": "abc"})"), "fade: \"abc\" is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": "1 s"})"), "fade: \"1 s\" is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": ""})"), "fade: \"\" is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": true})"), "fade: boolean is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": null})"), "fade: null is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": [1]})"), "fade: array is no number");
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"fade": "inf"})"), "");
  EXPECT_EQ(refusal_of<ServoOptions>(R"({"proxy": {"rise_time": "x"}})"),
            "proxy: rise_time: \"x\" is no number");
}

TEST(OptionsJson, WhatIsNoWholeNumberIsRefused) {
  for (const char* number : {"1.5", "-1e9", "4294967296", "\"3\"", "true", "1e300"}) {
    const std::string json = fmt::format(R"({{"history": {}}})", number);
    EXPECT_EQ(refusal_of<PolicyOptions>(json.c_str()).substr(0, 9), "history: ") << json;
  }
  EXPECT_EQ(refusal_of<PolicyOptions>(R"({"history": 3})"), "");
}

TEST(OptionsJson, ListsOfAnotherLengthAreRefused) {
  for (const char* place : {"[0, 1]", "[0, 1, 2, 3]", "{}", "7"}) {
    Eigen::Vector3d taken;
    EXPECT_THROW(take_exact(Json::parse(place), taken), Error) << place;
    Eigen::Isometry3d pose;
    EXPECT_THROW(take_exact(Json::parse(place), pose), Error) << place;
  }
}

TEST(OptionsJson, WhatARecordingDoesNotHaveKeepsItsDefault) {
  FieldOptions options;
  take_exact(Json::parse(R"({"kind": "metaball"})"), options);
  EXPECT_EQ(options, FieldOptions{.kind = FieldOptions::Kind::metaball});
}

}  // namespace
}  // namespace palpate::session
