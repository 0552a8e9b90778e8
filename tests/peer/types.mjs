// Every type of ours by others' definitions and code: types.mjs < what print_types prints. Each message is
// decoded by the definitions of a distribution of ROS 2 and encoded again, which has to give the same bytes, and the
// same is done by our own schema, whose fields have to be those of the definitions. Prints what differs; exits with 1.
import { parse } from "@foxglove/rosmsg";
import { ros2humble, ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { readFileSync } from "node:fs";
import { withParts } from "./common.mjs";

const distributions = { ros2humble, ros2jazzy };
const ours = new Set(["omni_msgs/OmniFeedback", "omni_msgs/OmniButtonEvent"]); // in no distribution
const wrong = [];
let compared = 0;

// What of the definitions is in the bytes. Times and durations are types of their own to a parser.
function fields(definitions, name) {
  const of = (each) =>
    each.definitions
      .filter((field) => field.isConstant !== true)
      .map((field) => `${field.type}${field.isArray ? `[${field.arrayLength ?? ""}]` : ""} ${field.name}`);
  return Object.fromEntries(
    definitions.filter((each) => !each.name?.startsWith("builtin_interfaces/")).map((each) => [(each.name ?? name).replace("/msg/", "/"), of(each)]).sort(([a], [b]) => (a < b ? -1 : 1)));
}

function check(what, definitions, bytes) {
  try {
    const again = new MessageWriter(definitions).writeMessage(new MessageReader(definitions).readMessage(bytes));
    if (Buffer.compare(again, bytes) !== 0) wrong.push(`${what}: ${Buffer.from(again).toString("hex")} instead of ${bytes.toString("hex")}`);
    ++compared;
  } catch (error) {
    wrong.push(`${what}: ${error.message}`);
  }
}

const types = [...readFileSync(0, "utf8").matchAll(/^(\S+) \S+ (\S+)\n((?: {2}.*\n)*)/gm)];
for (const [, rosName, hex, indented] of types) {
  const name = rosName.replace("/msg/", "/");
  const bytes = Buffer.from(hex, "hex");
  const schema = parse(indented.replaceAll(/^ {2}/gm, ""), { ros2: true });
  check(`${name} by our schema`, schema, bytes);
  if (ours.has(name)) continue;
  for (const [distribution, all] of Object.entries(distributions)) {
    if (all[name] == undefined) {
      wrong.push(`${name}: ${distribution} has none`);
      continue;
    }
    const theirs = withParts(all, name);
    check(`${name} by ${distribution}`, theirs, bytes);
    const [told, there] = [schema, theirs].map((each) => JSON.stringify(fields(each, name)));
    if (told !== there) wrong.push(`${name}: our schema has ${told}, ${distribution} ${there}`);
  }
}
if (types.length === 0) wrong.push("no types came");
console.log(wrong.length > 0 ? wrong.join("\n") : `${types.length} types, ${compared} messages are the same`);
process.exit(wrong.length > 0 ? 1 : 0);
