// What the program tells people to do is done to the command line that earned it, and works.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

// What a message says behind these words, up to a blank or the end of its line.
std::string behind(const std::string& message, const std::string& words) {
  const std::size_t at = message.find(words);
  if (at == std::string::npos) return "(no \"" + words + "\" in: " + message + ")";
  const std::size_t begin = at + words.size();
  return message.substr(begin, message.find_first_of(" \n;", begin) - begin);
}

struct Shown {
  const char* before;  // of a command line
  const char* wrong;
  const char* behind;  // words, behind which the message shows what to write
};

TEST(ProgramRemedies, NumbersAreWrittenAsMessagesShow) {
  Shell shell;
  for (const Shown& each :
       {Shown{"touch synthetic:torus --duration 0.01 --viewpoint ", "1,2", "e.g. "},
        {"touch synthetic:torus --duration 0.01 --viewpoint ", "1,a,3", "e.g. "},
        {"info synthetic:torus --scale ", "mm", "e.g. "},
        {"info synthetic:torus --scale ", "1,2", "one number, --scale "}}) {
    const Outcome refused = shell.run(std::string(each.before) + each.wrong);
    EXPECT_NE(refused.code, 0) << each.before << each.wrong;
    std::string shown = behind(refused.err, each.behind);
    if (shown.ends_with(',')) shown.pop_back();
    const Outcome mended = shell.run(each.before + shown);
    EXPECT_EQ(mended.code, 0) << each.before << shown << ": " << mended.err;
  }
}

TEST(ProgramRemedies, PosesAreWrittenAsMessagesShow) {
  Shell shell;
  const std::string run = "touch synthetic:sphere --duration 0.01 --pose ";
  for (const char* wrong : {"sphere=0,0,0", "0,0,0,0,0,0,1", "sphere=0,0,0,0,0,0,a"}) {
    const Outcome refused = shell.run(run + wrong);
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_NE(refused.err.find("x,y,z,qx,qy,qz,qw"), std::string::npos) << refused.err;
  }
  const Outcome mended = shell.run(run + "sphere=0,0,0,0,0,0,1");
  EXPECT_EQ(mended.code, 0) << mended.err;
}

TEST(ProgramRemedies, SourcesThatTheHelpListsAreFelt) {
  Shell shell;
  const Outcome refused = shell.run("touch");
  EXPECT_NE(refused.err.find("'palpate touch --help' lists them"), std::string::npos);
  EXPECT_NE(shell.run("touch --help").out.find("synthetic:torus"), std::string::npos);
  EXPECT_EQ(shell.run("touch synthetic:torus --duration 0.01").code, 0);
}

TEST(ProgramRemedies, AFileInAFolderIsNamed) {
  Shell shell;
  EXPECT_NE(shell.run("touch .").err.find("sequence:FOLDER"), std::string::npos);
  shell.write("rows.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string named = behind(shell.run("info .").err, "such as ");
  EXPECT_EQ(named, "./rows.xyz.");
  EXPECT_EQ(shell.run("info " + named.substr(0, named.size() - 1)).code, 0);
}

TEST(ProgramRemedies, AMistypedOptionIsNamed) {
  Shell shell;
  const std::string run = "touch synthetic:torus --duration 0.01 ";
  const std::string near = behind(shell.run(run + "--frction 0.2").err, "did you mean ");
  EXPECT_EQ(near, "--friction-static?");
  EXPECT_EQ(shell.run(run + "--friction-static 0.2").code, 0);
}

// A port of this machine that somebody listens on.
class TakenPort {
 public:
  TakenPort() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here));
    ::listen(socket_, 1);
    socklen_t size = sizeof here;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size);
    number_ = ntohs(here.sin_port);
  }
  ~TakenPort() { ::close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  [[nodiscard]] int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

TEST(ProgramRemedies, APortThatIsFreeIsNamed) {
  Shell shell;
  const TakenPort taken;
  const std::string run = "touch synthetic:sphere --view --duration 0.1 --port ";
  const Outcome refused = shell.run(run + std::to_string(taken.number()));
  if (refused.err.find("without the page") != std::string::npos) GTEST_SKIP() << refused.err;
  EXPECT_EQ(refused.code, 1);
  const Outcome mended = shell.run(run + behind(refused.err, "another address or port, such as "));
  EXPECT_EQ(mended.code, 0) << refused.err << mended.err;
}

}  // namespace
}  // namespace palpate::app
