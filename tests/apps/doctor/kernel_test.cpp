#include <gtest/gtest.h>

#include "apps/doctor/made_up.hpp"

namespace palpate::app::doctor {
namespace {

constexpr const char* kClock = "sys/devices/system/clocksource/clocksource0/";
constexpr const char* kGovernor = "sys/devices/system/cpu/cpu1/cpufreq/scaling_governor";

// What the row of one check answers on a machine.
Finding answer(const char* what, const MadeUp& machine) {
  return about(what, check_all(machine.system, 1));
}

// Where no right was asked for, and none refused.
void no_requests(MadeUp& machine) {
  machine.system.try_realtime = [](double) { return RealtimeTrial{}; };
}

Finding jitter(MadeUp& machine, const RealtimeTrial& trial) {
  machine.system.try_realtime = [trial](double) { return trial; };
  return answer("jitter at 1 kHz", machine);
}

RealtimeTrial late_by(double usual, double longest) {
  Durations lateness;
  for (int i = 0; i < 1999; ++i) lateness.add(usual);
  lateness.add(longest);
  RealtimeTrial trial;
  trial.lateness = lateness;
  trial.left_out = longest < 1e-3 ? 0 : 1;
  return trial;
}

TEST(DoctorKernel, TellsARealTimeKernelFromOthers) {
  MadeUp machine;
  machine.file("proc/version", "Linux version 6.1.0-18-amd64 (x@y) #1 SMP PREEMPT_DYNAMIC Debian");
  const Finding plain = answer("preemption", machine);
  EXPECT_EQ(plain.severity, Severity::note);
  EXPECT_NE(plain.words.find("6.1.0-18-amd64"), std::string::npos) << plain.words;
  EXPECT_NE(plain.remedy.find("linux-image-rt-amd64"), std::string::npos) << plain.remedy;
  machine.file("etc/os-release", "NAME=\"Ubuntu\"\nID=ubuntu");
  EXPECT_NE(answer("preemption", machine).remedy.find("pro enable"), std::string::npos);
  machine.file("sys/kernel/realtime", "1");
  EXPECT_EQ(answer("preemption", machine).severity, Severity::good);
}

TEST(DoctorKernel, WarnsOfGovernorsThatSlowProcessorsDown) {
  MadeUp machine;
  EXPECT_EQ(answer("frequency governor", machine).severity,
            Severity::good);  // nothing slows them down
  machine.file("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  EXPECT_EQ(answer("frequency governor", machine).severity, Severity::good);
  machine.file(kGovernor, "schedutil");
  EXPECT_EQ(answer("frequency governor", machine).severity, Severity::note);
  machine.file(kGovernor, "powersave");
  const Finding finding = answer("frequency governor", machine);
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_NE(finding.words.find("powersave"), std::string::npos);
  EXPECT_NE(finding.remedy.find("echo performance | sudo tee"), std::string::npos);
}

TEST(DoctorKernel, WarnsOfSlowClocksAndSaysWhetherAQuickOneIsThere) {
  MadeUp machine;
  EXPECT_EQ(answer("clock source", machine).severity, Severity::note);  // not told
  machine.file(std::string(kClock) + "current_clocksource", "hpet");
  machine.file(std::string(kClock) + "available_clocksource", "tsc hpet acpi_pm");
  const Finding slow = answer("clock source", machine);
  EXPECT_EQ(slow.severity, Severity::warning);
  EXPECT_EQ(slow.remedy.find("echo tsc | sudo tee"), 0u) << slow.remedy;
  machine.file(std::string(kClock) + "available_clocksource", "hpet acpi_pm");
  const Finding refused = answer("clock source", machine);
  EXPECT_NE(refused.remedy.find("dmesg"), std::string::npos) << refused.remedy;
  machine.file(std::string(kClock) + "current_clocksource", "kvm-clock");
  EXPECT_EQ(answer("clock source", machine).severity, Severity::good);
}

TEST(DoctorJitter, IsGoodWhereNoStepIsLeftOut) {
  MadeUp machine;
  const Finding finding = jitter(machine, late_by(30e-6, 200e-6));
  EXPECT_EQ(finding.severity, Severity::good);
  EXPECT_NE(finding.words.find("2 000 steps"), std::string::npos) << finding.words;
}

TEST(DoctorJitter, DrawsEveryStepInARowOfItsOctave) {
  MadeUp machine;
  const Finding finding = jitter(machine, late_by(30e-6, 200e-6));
  ASSERT_EQ(finding.lines.size(), 4u);  // 16-32, 32-64, 64-128, 128-256 us
  EXPECT_NE(finding.lines.front().find("< 32.0 us    1 999 ####"), std::string::npos)
      << finding.lines.front();
  EXPECT_NE(finding.lines.back().find("1 #"), std::string::npos) << finding.lines.back();
  EXPECT_EQ(finding.lines[1].find('#'), std::string::npos) << finding.lines[1];
}

TEST(DoctorJitter, WarnsOfStepsThatAreUsuallyLateAndPointsToWhatIsMissing) {
  MadeUp machine;
  machine.file("proc/cpuinfo", "flags : fpu hypervisor lahf");
  const Finding rare = jitter(machine, late_by(30e-6, 5e-3));
  EXPECT_EQ(rare.severity, Severity::note);
  EXPECT_NE(rare.words.find("virtual machine"), std::string::npos) << rare.words;
  // Rights were not refused.
  EXPECT_EQ(rare.remedy, "sudo apt install linux-image-rt-amd64 && sudo reboot");
  RealtimeTrial often = late_by(2e-3, 5e-3);
  often.report.requests = {{"priority", false, "no"}};
  const Finding finding = jitter(machine, often);
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_EQ(finding.remedy, answer("limits", machine).remedy);
}

TEST(DoctorRights, PointToTheLimitsThatComeWithPalpate) {
  const MadeUp machine;
  const Findings findings = check_all(machine.system, 0);
  const Finding priority = about("real-time priority 80 (SCHED_FIFO)", findings);
  EXPECT_EQ(priority.severity, Severity::warning);
  EXPECT_NE(priority.remedy.find(machine.system.share.string() + "/palpate-limits.conf"),
            std::string::npos)
      << priority.remedy;
  EXPECT_EQ(about("limits", findings).severity, Severity::note);
}

TEST(DoctorRights, SayWhatIsLeftToDoWhereTheLimitsAreThere) {
  MadeUp machine;
  machine.file("etc/security/limits.d/palpate-limits.conf", "");
  EXPECT_EQ(answer("limits", machine).remedy.find("sudo usermod"), 0u);
  machine.file(".dockerenv", "");
  EXPECT_EQ(answer("limits", machine).remedy.find("docker run"), 0u);
}

TEST(DoctorRights, TellWhatTheKernelLeavesToRealTimeThreads) {
  MadeUp machine;
  no_requests(machine);
  const auto share = [&machine](const std::string& microseconds) {
    machine.file("proc/sys/kernel/sched_rt_runtime_us", microseconds);
    return answer("share of real-time threads", machine).severity;
  };
  EXPECT_EQ(share("950000"), Severity::good);
  EXPECT_EQ(share("-1"), Severity::good);
  EXPECT_EQ(share("100000"), Severity::warning);
  EXPECT_EQ(share("0"), Severity::problem);
}

TEST(DoctorRights, ReadTheLimitsOfTheProcess) {
  MadeUp machine;
  machine.make_healthy();
  machine.file("proc/self/limits",
               "Limit                     Soft Limit           Hard Limit           Units     \n"
               "Max locked memory         8388608              8388608              bytes     \n"
               "Max realtime priority     95                   95                             ");
  const Finding limits = answer("limits", machine);
  EXPECT_EQ(limits.words.find("rtprio 95, memlock 8388608"), 0u) << limits.words;
}

}  // namespace
}  // namespace palpate::app::doctor
