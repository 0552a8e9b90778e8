#include "apps/palpate/options/live_options.hpp"

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/option_checks.hpp"

namespace palpate::app {

void add_live_options(CLI::App& command, LiveOptions& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Real time");
  };
  add("--maximum-force", o.maximum_force,
      "largest force that goes to the device, never more than it can hold (what the device can "
      "hold)")
      ->check(positive())
      ->type_name("N");
  add("--processor", o.processor,
      "the servo's thread runs on this processor alone, counted from 0; best one that is kept free "
      "(isolcpus=N)")
      ->check(whole_number(0, 1023))
      ->type_name("N");
}

void add_live_setup_options(CLI::App& file, LiveOptions& o) {
  file.add_option("--slew", o.slew)->check(positive());
  file.add_option("--watchdog", o.watchdog)->check(number("a time from 0.001 to 1 s", [](double x) {
    return x >= 1e-3 && x <= 1;
  }));
  file.add_option("--damping", o.damping)->check(not_negative());
  file.add_option("--soft-start", o.soft_start)
      ->check(number("a time from 0 to 60 s", [](double x) { return x >= 0 && x <= 60; }));
  file.add_flag("--passivity", o.passivity);
  file.add_option("--priority", o.priority)->check(whole_number(1, 99));
  file.add_flag("--realtime", o.realtime);
  file.add_flag("--lock-memory", o.lock_memory);
}

GuardOptions guard_options(const LiveOptions& options) {
  GuardOptions guard;
  guard.maximum_force = options.maximum_force.value_or(guard.maximum_force);
  guard.slew = options.slew.value_or(guard.slew);
  guard.silence = options.watchdog.value_or(guard.silence);
  guard.damping = options.damping.value_or(guard.damping);
  guard.soft_start = options.soft_start.value_or(guard.soft_start);
  guard.passivity.on = options.passivity;
  return guard;
}

RealtimeOptions realtime_options(const LiveOptions& options) {
  RealtimeOptions result;
  result.realtime_priority = options.realtime;
  result.priority = options.priority.value_or(result.priority);
  result.lock_memory = options.lock_memory;
  result.processor = options.processor;
  return result;
}

}  // namespace palpate::app
