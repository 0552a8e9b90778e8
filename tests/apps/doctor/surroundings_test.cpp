#include <gtest/gtest.h>

#include <cstdlib>

#include "apps/doctor/made_up.hpp"

namespace palpate::app::doctor {
namespace {

// What the row of one check answers on a machine.
Finding finding_on(const char* what, const MadeUp& machine) {
  return about(what, check_all(machine.system, 0));
}

// One of everything that can be wrong.
void break_everything(MadeUp& machine) {
  machine.file("proc/version", "Linux version 6.1.0-18-amd64 #1 SMP PREEMPT_DYNAMIC");
  machine.file("proc/sys/kernel/sched_rt_runtime_us", "0");
  machine.file("proc/sys/net/core/rmem_max", "212992");
  machine.file("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  machine.file("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  machine.usb("1-1", "1451", "0402", 1, 2);
  machine.usb("1-2", "045e", "02ae", 1, 3, "gspca_kinect");
  machine.usb("1-3", "1d27", "0601", 1, 4);
  machine.usb("1-4", "8086", "0b07", 1, 5, "uvcvideo", "RealSense");
  machine.usb("1-5", "1209", "0001", 1, 6, "", "Haply");
  machine.usb("1-6", "2988", "0302", 1, 7);
  machine.system.node = [](const std::filesystem::path&) { return Node{.there = true}; };
  machine.system.variables = {{"DISPLAY", ":0"},
                              {"LANG", "de_DE.UTF-8"},
                              {"LC_TIME", "$(ls)"},
                              {"RMW_IMPLEMENTATION", "rmw_zenoh_cpp"},
                              {"ROS_DOMAIN_ID", "$(ls)"},
                              {"ROS_AUTOMATIC_DISCOVERY_RANGE", "MOON"},
                              {"CYCLONEDDS_URI", "file:///etc/$(ls).xml"}};
}

// May all be pasted into a shell?
bool shell_reads(const std::string& commands) {
  const test::Folder folder;
  folder.write("commands", commands);
  return std::system(("sh -n '" + folder / "commands" + "'").c_str()) == 0;
}

void expect_remedies(const Findings& findings) {
  std::string commands;
  for (const auto& finding : as_json(findings)) {
    EXPECT_EQ(finding["severity"] == "good", finding["remedy"] == "") << finding;
    EXPECT_NE(finding["words"], "") << finding;
    commands += finding["remedy"].get<std::string>() + "\n";
  }
  EXPECT_TRUE(shell_reads(commands)) << commands;
}

TEST(DoctorChecks, GiveACommandForAllThatIsNotGood) {
  const MadeUp bare;
  const Findings findings = check_all(bare.system, 0);
  expect_remedies(findings);
  EXPECT_EQ(worst(findings), Severity::warning);  // no rights, no files; no device is no problem
  MadeUp broken;
  break_everything(broken);
  expect_remedies(check_all(broken.system, 0));
  broken.file(".dockerenv", "");
  expect_remedies(check_all(broken.system, 0));
}

TEST(DoctorChecks, FindNothingWrongWhereNothingIs) {
  MadeUp machine;
  machine.make_healthy();
  EXPECT_EQ(worst(check_all(machine.system, 0)), Severity::note);  // no device, no driver
}

TEST(DoctorChecks, KeepAreasTogether) {
  const MadeUp bare;
  std::vector<std::string> areas;
  for (const Finding& finding : check_all(bare.system, 0)) {
    if (areas.empty() || areas.back() != finding.area) areas.push_back(finding.area);
  }
  EXPECT_EQ(areas, (std::vector<std::string>{"kernel", "real-time rights", "haptic devices",
                                             "cameras", "ROS 2", "surroundings"}));
}

TEST(DoctorChecks, MeasureJitterWhenTold) {
  MadeUp machine;
  machine.system.try_realtime = [](double seconds) {
    RealtimeTrial trial;
    Durations lateness;
    for (double t = 0; t < seconds; t += 0.25) lateness.add(1e-5);
    trial.lateness = lateness;
    return trial;
  };
  const Finding jitter = about("jitter at 1 kHz", check_all(machine.system, 1));
  EXPECT_EQ(jitter.words.find("4 steps"), 0u) << jitter.words;
  EXPECT_EQ(as_json({jitter})[0]["lines"].size(), 1u);
}

TEST(DoctorLocale, ThatDoesNotExistIsMadeOrLeft) {
  MadeUp machine;
  machine.system.variables = {{"LC_ALL", "de_DE.UTF-8"}};
  const Finding finding = finding_on("locale", machine);
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_EQ(finding.remedy,
            "sudo apt install locales && sudo localedef -i de_DE -f UTF-8 de_DE.UTF-8");
  machine.system.variables = {{"LANG", "$(reboot)_x.y"}};
  EXPECT_EQ(finding_on("locale", machine).remedy, "export LANG=C.UTF-8");
  machine.system.variables = {{"LANG", "sr_RS.UTF-8@latin"}};
  EXPECT_TRUE(
      finding_on("locale", machine).remedy.ends_with("-i sr_RS@latin -f UTF-8 sr_RS.UTF-8@latin"));
  machine.system.variables = {{"LANG", "C.UTF-8"}, {"LANGUAGE", "de"}};
  EXPECT_EQ(finding_on("locale", machine).severity, Severity::good);
}

TEST(DoctorLocale, WithADecimalCommaIsNamed) {
  MadeUp machine;
  machine.system.decimal_point = [](const std::string& name) {
    return std::optional<std::string>(name == "de_DE.UTF-8" ? "," : ".");
  };
  machine.system.variables = {{"LANG", "de_DE.UTF-8"}};
  EXPECT_EQ(finding_on("decimal point", machine).remedy, "export LC_NUMERIC=C.UTF-8");
  machine.system.variables["LC_NUMERIC"] = "C.UTF-8";
  EXPECT_EQ(finding_on("decimal point", machine).severity, Severity::good);
  machine.system.variables["LC_ALL"] = "de_DE.UTF-8";  // before all others
  EXPECT_EQ(finding_on("decimal point", machine).remedy, "export LC_ALL=C.UTF-8");
}

TEST(DoctorSurroundings, AreContentWithFilesThatAPackagePutInPlace) {
  MadeUp machine;
  machine.file("usr/lib/udev/rules.d/60-palpate.rules", "");
  EXPECT_EQ(finding_on("palpate's files", machine).severity, Severity::warning);
  machine.file("etc/security/limits.d/palpate-limits.conf", "");
  EXPECT_EQ(finding_on("palpate's files", machine).severity, Severity::good);
}

TEST(DoctorSurroundings, MissAFolderForTheRemoteDevicesSocket) {
  MadeUp machine;
  EXPECT_EQ(finding_on("XDG_RUNTIME_DIR", machine).severity, Severity::note);
  machine.system.variables = {{"XDG_RUNTIME_DIR", "/run/user/1000"}};
  EXPECT_EQ(finding_on("XDG_RUNTIME_DIR", machine).severity, Severity::warning);
  machine.file("run/user/1000/bus", "");
  EXPECT_EQ(finding_on("XDG_RUNTIME_DIR", machine).severity, Severity::good);
}

TEST(DoctorRos, ComparesTheNetworkBufferWithABurst) {
  MadeUp machine;
  machine.file("proc/sys/net/core/rmem_max", "212992");
  const Finding finding = finding_on("network buffer", machine);
  EXPECT_EQ(finding.severity, Severity::note);
  EXPECT_NE(finding.words.find("4.2 MB"), std::string::npos) << finding.words;
  machine.file("proc/sys/net/core/rmem_max", "8388608");
  EXPECT_EQ(finding_on("network buffer", machine).severity, Severity::good);
}

TEST(DoctorRos, SaysWhoIsNotSeenByDds) {
  MadeUp machine;
  const auto on = [&](const std::string& value) {
    machine.system.variables = {{"RMW_IMPLEMENTATION", value}};
    return finding_on("RMW_IMPLEMENTATION", machine);
  };
  EXPECT_EQ(on("").severity, Severity::good);
  EXPECT_EQ(on("rmw_fastrtps_cpp").severity, Severity::good);
  EXPECT_EQ(on("rmw_cyclonedds_cpp").severity, Severity::good);
  const Finding zenoh = on("rmw_zenoh_cpp");
  EXPECT_EQ(zenoh.severity, Severity::warning);
  EXPECT_EQ(zenoh.remedy, "zenoh-bridge-ros2dds");
  EXPECT_EQ(on("rmw_pigeon").severity, Severity::note);
}

TEST(DoctorRos, LooksAtDomainRangeAndSettings) {
  MadeUp machine;
  const auto severity = [&](const char* what, std::map<std::string, std::string> variables) {
    machine.system.variables = std::move(variables);
    return finding_on(what, machine).severity;
  };
  EXPECT_EQ(severity("ROS_DOMAIN_ID", {{"ROS_DOMAIN_ID", "42"}}), Severity::good);
  EXPECT_EQ(severity("ROS_DOMAIN_ID", {{"ROS_DOMAIN_ID", "150"}}), Severity::note);
  EXPECT_EQ(severity("ROS_DOMAIN_ID", {{"ROS_DOMAIN_ID", "233"}}), Severity::problem);
  EXPECT_EQ(severity("ROS_DOMAIN_ID", {{"ROS_DOMAIN_ID", "4x"}}), Severity::problem);
  const char* range = "ROS_AUTOMATIC_DISCOVERY_RANGE";
  EXPECT_EQ(severity("visible to", {{range, "SUBNET"}}), Severity::good);
  EXPECT_EQ(severity("visible to", {{range, "SUBNET"}, {"ROS_LOCALHOST_ONLY", "1"}}),
            Severity::note);
  EXPECT_EQ(severity("visible to", {{range, "OFF"}}), Severity::note);
  EXPECT_EQ(severity("visible to", {{range, "MOON"}}), Severity::problem);
  EXPECT_EQ(severity("visible to", {{"ROS_STATIC_PEERS", "robot"}}), Severity::good);
  EXPECT_EQ(severity("CYCLONEDDS_URI", {{"CYCLONEDDS_URI", "file:///etc/cyclone.xml"}}),
            Severity::problem);
  machine.file("etc/cyclone.xml", "<CycloneDDS/>");
  EXPECT_EQ(severity("CYCLONEDDS_URI", {{"CYCLONEDDS_URI", "file:///etc/cyclone.xml"}}),
            Severity::good);
  EXPECT_EQ(severity("CYCLONEDDS_URI", {{"CYCLONEDDS_URI", "<CycloneDDS/>"}}), Severity::good);
}

TEST(DoctorRos, TellsWhetherTheBuildHasDds) {
  MadeUp machine;
  EXPECT_EQ(finding_on("DDS", machine).severity, Severity::note);
  machine.system.cameras = [] {
    return std::vector<DriverInfo>{{.name = "ros", .description = ""}};
  };
  EXPECT_EQ(finding_on("DDS", machine).severity, Severity::good);
}

TEST(DoctorSurroundings, NeedABrowserOnADesktopOnly) {
  MadeUp machine;
  EXPECT_NE(finding_on("browser", machine).remedy.find("ssh"), std::string::npos);
  machine.system.variables = {{"WAYLAND_DISPLAY", "wayland-0"}};
  EXPECT_NE(finding_on("browser", machine).remedy.find("apt install"), std::string::npos);
  machine.file("usr/bin/xdg-open", "");
  machine.file("snap/bin/firefox", "");
  EXPECT_EQ(finding_on("browser", machine).severity, Severity::good);
}

}  // namespace
}  // namespace palpate::app::doctor
