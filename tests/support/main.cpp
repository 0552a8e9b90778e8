// The main() of every test program. Where PALPATE_TEST_TIMES names a file, each case leaves a line
// there: name, seconds, seconds of processor time with its child processes, and how it ended,
// separated by tabs. The line of a case that crashes ends behind its name. scripts/times.py reads
// such files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/times.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

/// The processor time that this process and its ended children have taken, in seconds, to the tick
/// of 10 ms. (Emscripten's getrusage() writes beyond its result.)
double processor_time() {
  tms taken{};
  times(&taken);
  const clock_t sum = taken.tms_utime + taken.tms_stime + taken.tms_cutime + taken.tms_cstime;
  return static_cast<double>(sum) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

class Times : public testing::EmptyTestEventListener {
 public:
  explicit Times(std::FILE* file) : file_(file) {}
  ~Times() override { std::fclose(file_); }
  Times(const Times&) = delete;
  Times& operator=(const Times&) = delete;

  void OnTestStart(const testing::TestInfo& info) override {
    std::fprintf(file_, "%s.%s", info.test_suite_name(), info.name());
    std::fflush(file_);
    start_ = std::chrono::steady_clock::now();
    processor_start_ = processor_time();
  }

  void OnTestEnd(const testing::TestInfo& info) override {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
    const testing::TestResult& result = *info.result();
    const char* end = result.Failed() ? "failed" : result.Skipped() ? "skipped" : "passed";
    std::fprintf(file_, "\t%.3f\t%.3f\t%s\n", taken.count(), processor_time() - processor_start_,
                 end);
    std::fflush(file_);
  }

 private:
  std::FILE* file_;
  std::chrono::steady_clock::time_point start_;
  double processor_start_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  const char* name = std::getenv("PALPATE_TEST_TIMES");
  if (std::FILE* file = name == nullptr ? nullptr : std::fopen(name, "w")) {
    testing::UnitTest::GetInstance()->listeners().Append(new Times(file));
  }
  return RUN_ALL_TESTS();
}
