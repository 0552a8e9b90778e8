#include "apps/palpate/doctor/kernel.hpp"

#include <gtest/gtest.h>

#include "apps/doctor/made_up.hpp"
#include "apps/palpate/doctor/jitter.hpp"
#include "apps/palpate/doctor/rights.hpp"

namespace palpate::app::doctor {
namespace {

constexpr const char* kClock = "sys/devices/system/clocksource/clocksource0/";
constexpr const char* kGovernor = "sys/devices/system/cpu/cpu1/cpufreq/scaling_governor";

RealtimeTrial late_by(double usual, double longest) {
  Histogram lateness;
  for (int i = 0; i < 1999; ++i) lateness.add(usual);
  lateness.add(longest);
  RealtimeTrial trial;
  trial.lateness = lateness.look();
  trial.left_out = longest < 1e-3 ? 0 : 1;
  return trial;
}

TEST(DoctorKernel, TellsARealTimeKernelFromOthers) {
  MadeUp machine;
  machine.file("proc/version", "Linux version 6.1.0-18-amd64 (x@y) #1 SMP PREEMPT_DYNAMIC Debian");
  const Finding plain = check_preemption(machine.system);
  EXPECT_EQ(plain.severity, Severity::note);
  EXPECT_NE(plain.words.find("6.1.0-18-amd64"), std::string::npos) << plain.words;
  EXPECT_NE(plain.remedy.find("linux-image-rt-amd64"), std::string::npos) << plain.remedy;
  machine.file("etc/os-release", "NAME=\"Ubuntu\"\nID=ubuntu");
  EXPECT_NE(check_preemption(machine.system).remedy.find("pro enable"), std::string::npos);
  machine.file("sys/kernel/realtime", "1");
  EXPECT_EQ(check_preemption(machine.system).severity, Severity::good);
}

TEST(DoctorKernel, WarnsOfGovernorsThatSlowProcessorsDown) {
  MadeUp machine;
  EXPECT_EQ(check_governor(machine.system).severity, Severity::good);  // nothing slows them down
  machine.file("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  EXPECT_EQ(check_governor(machine.system).severity, Severity::good);
  machine.file(kGovernor, "schedutil");
  EXPECT_EQ(check_governor(machine.system).severity, Severity::note);
  machine.file(kGovernor, "powersave");
  const Finding finding = check_governor(machine.system);
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_NE(finding.words.find("powersave"), std::string::npos);
  EXPECT_NE(finding.remedy.find("echo performance | sudo tee"), std::string::npos);
}

TEST(DoctorKernel, WarnsOfSlowClocksAndSaysWhetherAQuickOneIsThere) {
  MadeUp machine;
  EXPECT_EQ(check_clock_source(machine.system).severity, Severity::note);  // not told
  machine.file(std::string(kClock) + "current_clocksource", "hpet");
  machine.file(std::string(kClock) + "available_clocksource", "tsc hpet acpi_pm");
  const Finding slow = check_clock_source(machine.system);
  EXPECT_EQ(slow.severity, Severity::warning);
  EXPECT_EQ(slow.remedy.find("echo tsc | sudo tee"), 0u) << slow.remedy;
  machine.file(std::string(kClock) + "available_clocksource", "hpet acpi_pm");
  const Finding refused = check_clock_source(machine.system);
  EXPECT_NE(refused.remedy.find("dmesg"), std::string::npos) << refused.remedy;
  machine.file(std::string(kClock) + "current_clocksource", "kvm-clock");
  EXPECT_EQ(check_clock_source(machine.system).severity, Severity::good);
}

TEST(DoctorJitter, IsGoodWhereNoStepIsLeftOut) {
  const MadeUp machine;
  const Finding finding = check_jitter(machine.system, late_by(30e-6, 200e-6));
  EXPECT_EQ(finding.severity, Severity::good);
  EXPECT_NE(finding.words.find("2 000 steps"), std::string::npos) << finding.words;
}

TEST(DoctorJitter, DrawsEveryStepInARowOfItsOctave) {
  const MadeUp machine;
  const Finding finding = check_jitter(machine.system, late_by(30e-6, 200e-6));
  ASSERT_EQ(finding.lines.size(), 4u);  // 16-32, 32-64, 64-128, 128-256 us
  EXPECT_NE(finding.lines.front().find("< 32.0 us    1 999 ####"), std::string::npos)
      << finding.lines.front();
  EXPECT_NE(finding.lines.back().find("1 #"), std::string::npos) << finding.lines.back();
  EXPECT_EQ(finding.lines[1].find('#'), std::string::npos) << finding.lines[1];
}

TEST(DoctorJitter, WarnsOfStepsThatAreUsuallyLateAndPointsToWhatIsMissing) {
  MadeUp machine;
  machine.file("proc/cpuinfo", "flags : fpu hypervisor lahf");
  const Finding rare = check_jitter(machine.system, late_by(30e-6, 5e-3));
  EXPECT_EQ(rare.severity, Severity::note);
  EXPECT_NE(rare.words.find("virtual machine"), std::string::npos) << rare.words;
  EXPECT_EQ(rare.remedy, realtime_kernel_command(machine.system));  // rights were not refused
  RealtimeTrial often = late_by(2e-3, 5e-3);
  often.report.requests = {{"priority", false, "no"}};
  const Finding finding = check_jitter(machine.system, often);
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_EQ(finding.remedy, rights_command(machine.system));
}

TEST(DoctorRights, PointToTheLimitsThatComeWithPalpate) {
  const MadeUp machine;
  const RealtimeReport report = machine.system.try_realtime(0).report;
  const Findings findings = check_rights(machine.system, report);
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
  EXPECT_EQ(rights_command(machine.system).find("sudo usermod"), 0u);
  machine.file(".dockerenv", "");
  EXPECT_EQ(rights_command(machine.system).find("docker run"), 0u);
}

TEST(DoctorRights, TellWhatTheKernelLeavesToRealTimeThreads) {
  MadeUp machine;
  const auto share = [&machine](const std::string& microseconds) {
    machine.file("proc/sys/kernel/sched_rt_runtime_us", microseconds);
    return about("share of real-time threads", check_rights(machine.system, {})).severity;
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
  const Finding limits = about("limits", check_rights(machine.system, {}));
  EXPECT_EQ(limits.words.find("rtprio 95, memlock 8388608"), 0u) << limits.words;
}

}  // namespace
}  // namespace palpate::app::doctor
