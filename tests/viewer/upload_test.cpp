// A page gives the program a file: "PUT /open/NAME".
#include "viewer/upload.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::RawClient;
using test::ViewerRig;

struct Sent {
  std::vector<std::pair<std::string, std::string>> files;  // name, bytes

  ViewerControls controls() {
    ViewerControls controls;
    controls.open = [this](const std::string& name, std::string bytes) {
      if (name == "busy.ply") throw Error("one file at a time");
      files.emplace_back(name, std::move(bytes));
    };
    return controls;
  }
};

std::string put(const ViewerRig& rig, const std::string& name, const std::string& rest,
                const std::string& token = ViewerRig::kToken) {
  return "PUT /open/" + name + " HTTP/1.1\r\nHost: " + rig.host() + "\r\nAuthorization: Bearer " +
         token + "\r\n" + rest;
}

std::string of_length(const std::string& bytes) {
  return "Content-Length: " + std::to_string(bytes.size()) + "\r\n\r\n" + bytes;
}

// What is answered: the status and, behind it, the words.
std::string answer(const ViewerRig& rig, const std::string& request) {
  RawClient client(rig.viewer->port());
  client.send(request);
  const std::string header = client.read_header();
  return header.substr(9, 3) + " " + client.read_body(header);
}

TEST(Upload, AFileComesWithItsNameAndAllItsBytes) {
  Sent sent;
  ViewerRig rig({}, sent.controls());
  const std::string bytes(300'000, '\xb1');
  EXPECT_EQ(answer(rig, put(rig, "a-b_1.ply", of_length(bytes))), "202 ");
  EXPECT_EQ(answer(rig, put(rig, "empty.xyz", of_length(""))), "202 ");
  EXPECT_EQ(answer(rig, put(rig, "in_chunks.xyz",
                            "Transfer-Encoding: chunked\r\n\r\n3\r\n0 0\r\n2\r\n 0\r\n0\r\n\r\n")),
            "202 ");
  ASSERT_EQ(sent.files.size(), 3U);
  EXPECT_EQ(sent.files[0], std::pair(std::string("a-b_1.ply"), bytes));
  EXPECT_EQ(sent.files[1].second, "");
  EXPECT_EQ(sent.files[2].second, "0 0 0");
}

TEST(Upload, PagesAreToldWhetherTheyMaySendOne) {
  Sent sent;
  ViewerOptions options;
  options.limits.file = 1234;
  const auto welcome = [](const ViewerRig& rig) {
    RawClient client(rig.viewer->port());
    client.upgrade(rig.host());
    client.send_text(R"({"type":"hello","token":"secret","points":0})");
    return client.receive_json("welcome");
  };
  EXPECT_EQ(welcome(ViewerRig(options, sent.controls()))["opens"], 1234);
  EXPECT_FALSE(welcome(ViewerRig(options)).contains("opens"));
}

TEST(Upload, WhoDoesNotKnowTheTokenIsRefusedBeforeAByteIsTaken) {
  Sent sent;
  ViewerRig rig({}, sent.controls());
  const std::string long_file = of_length(std::string(2'000'000, 'x'));
  EXPECT_EQ(answer(rig, put(rig, "a.ply", long_file, "guess")), "401 Wrong token.");
  EXPECT_EQ(answer(rig, put(rig, "a.ply", long_file, "")), "401 Wrong token.");
  RawClient other(rig.viewer->port());
  other.send("PUT /open/a.ply HTTP/1.1\r\nHost: " + rig.host() +
             "\r\nOrigin: http://elsewhere\r\nAuthorization: Bearer secret\r\n" + of_length("x"));
  EXPECT_TRUE(other.read_header().starts_with("HTTP/1.1 403"));
  rig.wait([](const Viewer::Counts& counts) { return counts.forbidden == 3; });
  EXPECT_TRUE(sent.files.empty());
}

TEST(Upload, NamesThatLeadElsewhereAreRefused) {
  Sent sent;
  ViewerRig rig({}, sent.controls());
  for (const char* name : {"", "..", ".bashrc", "a/b.ply", "..%2fb.ply", "a%2Fb.ply", "a%00.ply",
                           "a%1b.ply", "%2e.ply", "a%.ply", "a%4", "a%-4.ply", "a%4x.ply"}) {
    EXPECT_EQ(answer(rig, put(rig, name, of_length("x"))).substr(0, 3), "400") << name;
  }
  EXPECT_EQ(viewer::file_name(std::string(250, 'a')), std::string(250, 'a'));
  EXPECT_EQ(viewer::file_name(std::string(251, 'a')), "");
  EXPECT_TRUE(sent.files.empty());
}

TEST(Upload, NamesOfAllLanguagesComeAsTheyAre) {
  EXPECT_EQ(viewer::file_name("Gr%C3%B6%c3%9fe%20(2)%25.ply"),
            "Gr\xc3\xb6\xc3\x9f"
            "e (2)%.ply");
  EXPECT_EQ(viewer::file_name("a?b=c.ply"), "a?b=c.ply");
}

TEST(Upload, WhatIsTooLargeIsRefusedAnnouncedOrNot) {
  Sent sent;
  ViewerOptions options;
  options.limits.file = 1000;
  ViewerRig rig(options, sent.controls());
  EXPECT_EQ(answer(rig, put(rig, "a.ply", "Content-Length: 99999999999\r\n\r\n")).substr(0, 3),
            "413");
  const std::string chunk = "3e8\r\n" + std::string(1000, 'x') + "\r\n";
  EXPECT_EQ(answer(rig, put(rig, "a.ply", "Transfer-Encoding: chunked\r\n\r\n" + chunk + chunk))
                .substr(0, 3),
            "413");
  EXPECT_EQ(answer(rig, put(rig, "a.ply", of_length(std::string(1000, 'x')))), "202 ");
  EXPECT_EQ(sent.files.size(), 1U);
}

TEST(Upload, OneFileIsTakenAtATimeAndOneThatIsBrokenOffLeavesRoom) {
  Sent sent;
  ViewerRig rig({}, sent.controls());
  {
    RawClient slow(rig.viewer->port());
    slow.send(put(rig, "slow.ply", "Content-Length: 1000\r\n\r\nhalf"));
    std::string second;
    while (!second.starts_with("409")) second = answer(rig, put(rig, "b.ply", of_length("x")));
    EXPECT_NE(second.find("Another file is being sent"), std::string::npos);
    sent.files.clear();
  }
  rig.wait([](const Viewer::Counts& counts) { return counts.connections == 0; });
  EXPECT_EQ(answer(rig, put(rig, "c.ply", of_length("x"))), "202 ");
  EXPECT_EQ(sent.files.size(), 1U);
}

TEST(Upload, WhatTheProgramRefusesIsSaidInItsWords) {
  Sent sent;
  ViewerRig rig({}, sent.controls());
  EXPECT_EQ(answer(rig, put(rig, "busy.ply", of_length("x"))), "409 one file at a time");
}

TEST(Upload, ARunThatOpensNothingSaysSo) {
  ViewerRig rig;
  EXPECT_EQ(answer(rig, put(rig, "a.ply", of_length("x"))).substr(0, 3), "404");
}

TEST(Upload, ARestartIsToldFromAnEnd) {
  ViewerRig rig;
  auto client = rig.enter();
  rig.viewer->restarts("the program opens a.ply");
  rig.viewer.reset();
  const test::Frame closing = client->receive_until([](const auto& f) { return f.opcode == 8; });
  EXPECT_EQ(closing.code(), 1012);
  EXPECT_EQ(closing.payload.substr(2), "the program opens a.ply");
}

TEST(Upload, LongWordsAtTheEndAreCutBetweenLetters) {
  ViewerRig rig;
  auto client = rig.enter();
  std::string letters;
  for (int i = 0; i < 80; ++i) letters += "\xd0\xbf";
  rig.viewer->restarts("a" + letters);
  rig.viewer.reset();
  const test::Frame closing = client->receive_until([](const auto& f) { return f.opcode == 8; });
  EXPECT_EQ(closing.payload.substr(2), "a" + letters.substr(0, 122));
}

}  // namespace
}  // namespace palpate
