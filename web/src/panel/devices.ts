// Notifies the person once of each change of a device: it is silent, has failed, responds again.

import type { Session } from "../model/session";
import type { DeviceReport } from "../protocol/messages";
import type { Notices } from "./notices";

export class Devices {
  constructor(
    private readonly session: Session,
    private readonly notices: Notices,
  ) {}

  take(reports: readonly DeviceReport[]): void {
    reports.forEach((report, i) => {
      const device = this.session.devices[i];
      if (device === undefined) return;
      const before = device.report.status;
      device.report = report;
      if (report.status !== before) this.notify(this.session.welcome?.devices[i]?.name ?? "", before, report);
    });
  }

  private notify(name: string, before: string, { status, reason }: DeviceReport): void {
    if (reason !== undefined) this.notices.add("warning", `${name}: ${reason}`);
    else if (status === "ok" && before === "silent") this.notices.add("info", `${name} is back`);
  }
}
