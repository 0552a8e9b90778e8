#pragma once

#include <functional>
#include <optional>
#include <string>

namespace palpate::dds {

/// Machines that can see palpate's topics.
enum class Range {
  localhost,  ///< programs on this machine
  subnet,     ///< all that the network's multicast reaches
};

struct DomainOptions {
  std::uint32_t id = 0;
  Range range = Range::localhost;
  std::string peers = {};    ///< further machines to contact, separated by ';', as ROS_STATIC_PEERS
  bool own_settings = true;  ///< false: CYCLONEDDS_URI sets how the domain is set up
};

/// Reads options from the environment: ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY,
/// ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS, CYCLONEDDS_URI.
/// @throws Error that names a variable whose value makes no sense.
[[nodiscard]] DomainOptions options_from(
    const std::function<std::optional<std::string>(const char*)>& environment);

/// The same of this process's environment.
[[nodiscard]] DomainOptions environment_options();

/// Cyclone DDS's settings for them. `receive_buffer`: the largest that the system allows, bytes.
[[nodiscard]] std::string settings_of(const DomainOptions& options, std::size_t receive_buffer);

/// This process's part in a domain: what readers and writers belong to. A process's first sets up
/// its domain; while that is there, others join it and their options but the id have no effect. Any
/// thread.
class Participant {
 public:
  /// @throws Error when the domain or the participant cannot be had.
  explicit Participant(const DomainOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] std::int32_t entity() const { return participant_; }

 private:
  std::int32_t participant_ = 0;
};

}  // namespace palpate::dds
