// The main() of every test program. Where PALPATE_TEST_TIMES names a file, each case leaves a line
// there: name, seconds, seconds of processor time with its child processes, and how it ended,
// separated by tabs. The line of a case that crashes ends behind its name. scripts/times.py reads
// such files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// The processor time that this process and its ended children have taken, in seconds.
double processor_time() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
  return sum;
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
