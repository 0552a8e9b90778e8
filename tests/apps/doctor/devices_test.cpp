#include <gtest/gtest.h>

#include <algorithm>

#include "apps/doctor/made_up.hpp"

namespace palpate::app::doctor {
namespace {

Findings examined(const MadeUp& machine) {
  return check_all(machine.system, 0);
}

std::ptrdiff_t count(const char* looked_at, const MadeUp& machine) {
  return std::ranges::count(examined(machine), looked_at, &Finding::looked_at);
}

TEST(DoctorDevices, AbsenceIsANoteAlone) {
  MadeUp machine;
  machine.file("sys/bus/usb/drivers_probe", "");
  Findings findings = examined(machine);
  std::erase_if(findings, [](const Finding& each) { return each.looked_at != "on USB"; });
  ASSERT_EQ(findings.size(), 2u);  // no haptic device, no camera
  EXPECT_EQ(worst(findings), Severity::note);
  EXPECT_EQ(findings.front().remedy, "palpate demo");
}

TEST(DoctorDevices, WhatIsNotToldIsNotCalledAbsent) {
  MadeUp machine;
  EXPECT_EQ(about("on USB", examined(machine)).remedy, kMountSys);
  machine.file("sys/bus/pci/drivers_probe", "");
  const Finding found = about("on USB", examined(machine));
  EXPECT_NE(found.words.find("does not list"), std::string::npos) << found.words;
  EXPECT_EQ(found.remedy, "sudo modprobe xhci_pci");
}

TEST(DoctorDevices, KnowsThemByTheirNumbersAndSomeByTheirWords) {
  MadeUp machine;
  machine.usb("1-1", "1451", "0402", 1, 2);
  machine.usb("1-2", "0403", "cb48", 1, 3);
  machine.usb("1-3", "0403", "6001", 1, 4);  // any serial cable
  machine.usb("1-4", "2988", "0302", 1, 5);
  machine.usb("1-5", "1209", "0001", 1, 6, "", "Haply USB Transceiver");
  machine.usb("1-6", "8086", "0b07", 1, 7, "uvcvideo", "Intel(R) RealSense(TM) Depth Camera 435");
  machine.usb("1-7", "8086", "0aa7", 1, 8, "btusb", "Bluetooth");
  std::vector<std::string> names;
  for (const auto& each : known_usb_devices(machine.system)) {
    names.emplace_back(each.model.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"Force Dimension", "Novint Falcon", "3D Systems Touch",
                                             "Haply", "RealSense"}));
}

TEST(DoctorDevices, SaysWhoMayOpenANodeThatThisUserMayNot) {
  MadeUp machine;
  machine.usb("1-4", "1451", "0402", 1, 12);
  EXPECT_EQ(about("Force Dimension", examined(machine)).severity, Severity::good);
  machine.system.node = [](const std::filesystem::path& path) {
    EXPECT_TRUE(path.string().ends_with("/dev/bus/usb/001/012")) << path;
    return Node{.there = true, .may_open = false, .group_may = true, .group = "plugdev"};
  };
  const Finding by_group = about("Force Dimension", examined(machine));
  EXPECT_EQ(by_group.severity, Severity::problem);
  EXPECT_EQ(by_group.remedy, "sudo usermod -aG plugdev \"$USER\"");
  machine.system.groups = {"plugdev"};  // a member already: something else is in the way
  const Finding by_rules = about("Force Dimension", examined(machine));
  EXPECT_NE(by_rules.remedy.find("60-palpate.rules"), std::string::npos) << by_rules.remedy;
  machine.file("usr/lib/udev/rules.d/60-palpate.rules", "");  // a package's
  EXPECT_EQ(about("Force Dimension", examined(machine)).remedy,
            "sudo udevadm control --reload && sudo udevadm trigger");
}

TEST(DoctorDevices, SaysSoWhereADeviceHasNoNode) {
  MadeUp machine;
  machine.usb("1-4", "2988", "0302", 1, 12);
  machine.system.node = [](const std::filesystem::path&) { return Node{}; };
  EXPECT_EQ(about("3D Systems Touch", examined(machine)).remedy, "sudo udevadm trigger");
  machine.file(".dockerenv", "");
  EXPECT_EQ(about("3D Systems Touch", examined(machine)).remedy.find("docker run"), 0u);
}

TEST(DoctorDevices, LooksAtTheTerminalsOfSerialOnes) {
  MadeUp machine;
  machine.usb("1-4", "2988", "0302", 1, 12);
  machine.terminal("1-4", "ttyACM0");
  machine.system.node = [](const std::filesystem::path& path) {
    const bool terminal = path.filename() == "ttyACM0";
    return Node{.there = true, .may_open = !terminal, .group_may = true, .group = "dialout"};
  };
  const Finding finding = about("3D Systems Touch", examined(machine));
  EXPECT_EQ(finding.severity, Severity::problem);
  EXPECT_EQ(finding.remedy, "sudo usermod -aG dialout \"$USER\"");
}

TEST(DoctorDevices, WarnsOfAKernelDriverThatHoldsAKinect) {
  MadeUp machine;
  machine.usb("2-1", "045e", "02ae", 2, 3, "gspca_kinect");
  const Finding finding = about("kernel drivers", examined(machine));
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_NE(finding.remedy.find("blacklist gspca_kinect"), std::string::npos);
  EXPECT_NE(finding.remedy.find("modprobe -r gspca_kinect"), std::string::npos);
  MadeUp other;
  other.usb("2-1", "045e", "02ae", 2, 3, "usbfs");
  EXPECT_EQ(count("kernel drivers", other), 0);
}

TEST(DoctorDevices, MissesTheCameraOfAKinectWithoutItsPowerSupply) {
  MadeUp machine;
  machine.usb("2-1", "045e", "02b0", 2, 3);
  const Finding finding = about("Kinect v1", examined(machine));
  EXPECT_EQ(finding.severity, Severity::problem);
  EXPECT_NE(finding.words.find("power"), std::string::npos) << finding.words;
  machine.usb("2-2", "045e", "02ae", 2, 4);
  EXPECT_EQ(about("Kinect v1", examined(machine)).severity, Severity::good);
}

TEST(DoctorDevices, WarnsOfCamerasThatShareABus) {
  MadeUp machine;
  machine.usb("1-1", "1d27", "0601", 1, 2);
  machine.usb("2-1", "1d27", "0601", 2, 2);
  EXPECT_EQ(count("USB bandwidth", machine), 0);
  machine.usb("2-2", "045e", "02ae", 2, 3);
  const Finding finding = about("USB bandwidth", examined(machine));
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_NE(finding.words.find("2 cameras share bus 2"), std::string::npos) << finding.words;
}

TEST(DoctorDrivers, AreMissedWhereACameraNeedsThem) {
  MadeUp machine;
  const auto kinect = [&] { return about("driver freenect", examined(machine)); };
  EXPECT_EQ(kinect().severity, Severity::note);
  EXPECT_EQ(kinect().remedy.find("sudo apt install libfreenect-dev"), 0u) << kinect().remedy;
  machine.usb("2-1", "045e", "02ae", 2, 3);
  EXPECT_EQ(kinect().severity, Severity::problem);
}

TEST(DoctorDrivers, AreSaidToBeBlindWhereTheyFindNothingOfWhatIsThere) {
  MadeUp machine;
  DriverInfo driver{.name = "openni2", .description = ""};
  machine.system.cameras = [&driver] { return std::vector{driver}; };
  const auto xtion = [&] { return about("driver openni2", examined(machine)); };
  EXPECT_EQ(xtion().severity, Severity::good);
  machine.usb("2-1", "1d27", "0601", 2, 3);
  EXPECT_EQ(xtion().severity, Severity::problem);
  driver.devices.push_back({"openni2:1d27/0601@2/3", "PS1080"});
  EXPECT_EQ(xtion().severity, Severity::good);
}

TEST(DoctorLibraries, AreMissedWhereADeviceNeedsThem) {
  MadeUp machine;
  const auto severity = [&machine](const std::string& library) {
    return about(library, examined(machine)).severity;
  };
  for (const char* library :
       {"libdhd.so.3", "libdrd.so.3", "libHD.so", "Haply's Inverse Service"}) {
    EXPECT_EQ(severity(library), Severity::note) << library;
  }
  machine.usb("1-1", "0403", "cb48", 1, 2);
  machine.usb("1-2", "1209", "0001", 1, 3, "", "Haply Inverse3");
  EXPECT_EQ(severity("libdhd.so.3"), Severity::problem);
  EXPECT_EQ(severity("libHD.so"), Severity::note);
  EXPECT_EQ(severity("Haply's Inverse Service"), Severity::problem);
  machine.system.listens = [](int port) { return port == 10001; };
  EXPECT_EQ(severity("Haply's Inverse Service"), Severity::good);
}

TEST(DoctorLibraries, TellTheirVersionOrWhatTheyMiss) {
  MadeUp machine;
  using Outcome = LibraryTrial::Outcome;
  machine.system.try_library = [](const std::string& name) {
    return name.starts_with("libHD.so")
               ? LibraryTrial{Outcome::broken,
                              "libncurses.so.5: cannot open shared object file: No such file"}
               : LibraryTrial{Outcome::loaded, "3.17.6.0"};
  };
  const Findings findings = examined(machine);
  EXPECT_EQ(about("libdhd.so.3", findings).words, "loaded, version 3.17.6.0");
  const Finding broken = about("libHD.so", findings);
  EXPECT_EQ(broken.severity, Severity::warning);
  EXPECT_TRUE(broken.remedy.ends_with("apt-file search libncurses.so.5")) << broken.remedy;
}

TEST(DoctorLibraries, AreFoundByTheirOtherNames) {
  MadeUp machine;
  using Outcome = LibraryTrial::Outcome;
  machine.system.try_library = [](const std::string& name) {
    return name == "libHD.so.3" ? LibraryTrial{Outcome::loaded, "3.4.0"} : LibraryTrial{};
  };
  const Findings findings = examined(machine);
  EXPECT_EQ(about("libHD.so", findings).words, "loaded, version 3.4.0");
}

TEST(DoctorLibraries, NeedATouchThatIsSetUp) {
  MadeUp machine;
  machine.usb("1-4", "2988", "0302", 1, 12);
  machine.system.variables = {{"HOME", "/home/ann"}};
  const auto setup = [&machine] { return about("Touch's set-up", examined(machine)); };
  EXPECT_EQ(setup().severity, Severity::problem);
  EXPECT_EQ(setup().remedy.find("export GTDD_HOME"), 0u) << setup().remedy;
  machine.file("home/ann/.3dsystems/config/Default Device.config", "ModelType=OMNI");
  EXPECT_EQ(setup().words, "Default Device in /home/ann/.3dsystems/config");
  machine.system.variables["GTDD_HOME"] = "/usr/share/3DSystems";
  EXPECT_EQ(setup().remedy.find("mkdir"), 0u) << setup().remedy;
}

}  // namespace
}  // namespace palpate::app::doctor
