// Turns ROS's environment variables into Cyclone DDS's configuration.
#include "dds/domain.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <fstream>

#include "palpate/base/error.hpp"

namespace palpate::dds {
namespace {

// Ports begin at 7400 + 250 d (DDSI-RTPS 9.6.1); those of larger d exceed 65535 (derived)
constexpr std::uint32_t kLargestDomain = 232;
// Bytes; a depth image is a burst of packets (judgement)
constexpr std::size_t kReceiveBuffer = 4 << 20;
// Participants of one machine that find one another without multicast.
constexpr int kParticipants = 32;

std::uint32_t domain_id(const std::string& text) {
  std::uint32_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size() || id > kLargestDomain) {
    throw Error(fmt::format("ROS_DOMAIN_ID is '{}'; it has to be a number from 0 to {}", text,
                            kLargestDomain));
  }
  return id;
}

// ROS 2 has the variable since Iron. SYSTEM_DEFAULT leaves the choice to palpate; OFF still allows
// what is on this machine.
Range range_from(const std::string& text) {
  if (text == "SUBNET") return Range::subnet;
  if (text == "LOCALHOST" || text == "OFF" || text == "SYSTEM_DEFAULT") return Range::localhost;
  throw Error(
      fmt::format("ROS_AUTOMATIC_DISCOVERY_RANGE is '{}'; it has to be LOCALHOST, SUBNET, OFF or "
                  "SYSTEM_DEFAULT",
                  text));
}

std::string peers_of(const std::string& list) {
  std::string peers;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(';', at), list.size());
    const std::string name = list.substr(at, end - at);
    if (name.find_first_of("<>&\"'") != std::string::npos) {
      throw Error(
          fmt::format("ROS_STATIC_PEERS: '{}' is not the name or address of a machine", name));
    }
    if (!name.empty()) peers += fmt::format(R"(<Peer address="{}"/>)", name);
    at = end + 1;
  }
  return peers;
}

std::size_t largest_receive_buffer() {
  std::size_t size = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> size;
  return size;
}

Error failure(const char* what, std::uint32_t id, std::int32_t code) {
  return Error(
      fmt::format("DDS: {} in domain {} failed ({}). 'palpate doctor' looks at ROS 2's settings.",
                  what, id, dds_strretcode(-code)));
}

}  // namespace

DomainOptions options_from(
    const std::function<std::optional<std::string>(const char*)>& environment) {
  DomainOptions options;
  if (const auto id = environment("ROS_DOMAIN_ID"); id && !id->empty()) options.id = domain_id(*id);
  if (const auto wide = environment("ROS_AUTOMATIC_DISCOVERY_RANGE"); wide && !wide->empty()) {
    options.range = range_from(*wide);
  }
  if (environment("ROS_LOCALHOST_ONLY") == "1") options.range = Range::localhost;
  options.peers = environment("ROS_STATIC_PEERS").value_or("");
  const auto settings = environment("CYCLONEDDS_URI");
  options.own_settings = !settings || settings->empty();
  return options;
}

DomainOptions environment_options() {
  return options_from([](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  });
}

std::string settings_of(const DomainOptions& options, std::size_t receive_buffer) {
  const std::string buffer =
      receive_buffer == 0
          ? ""
          : fmt::format(R"(<Internal><SocketReceiveBufferSize min="{}B"/></Internal>)",
                        std::min(receive_buffer, kReceiveBuffer));
  const std::string peers = peers_of(options.peers);
  std::string general;
  std::string discovery = peers.empty() ? "" : "<Peers>" + peers + "</Peers>";
  if (options.range == Range::localhost) {
    general = "<General><AllowMulticast>false</AllowMulticast></General>";
    discovery = fmt::format(
        R"(<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>)"
        R"(<Peers><Peer address="localhost"/>{}</Peers>)",
        kParticipants, peers);
  }
  return fmt::format(
      R"(<CycloneDDS><Domain Id="any">{}<Discovery>{}</Discovery>{}</Domain></CycloneDDS>)",
      general, discovery, buffer);
}

Participant::Participant(const DomainOptions& options) {
  if (options.own_settings) {
    const std::string settings = settings_of(options, largest_receive_buffer());
    const dds_entity_t domain = dds_create_domain(options.id, settings.c_str());
    if (domain < 0 && domain != DDS_RETCODE_PRECONDITION_NOT_MET) {
      throw failure("setting up", options.id, domain);
    }
  }
  participant_ = dds_create_participant(options.id, nullptr, nullptr);
  if (participant_ < 0) throw failure("taking part", options.id, participant_);
}

Participant::~Participant() {
  dds_delete(participant_);
}

}  // namespace palpate::dds
