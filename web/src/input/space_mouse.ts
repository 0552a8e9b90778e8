// A SpaceMouse through WebHID, where the browser has it: the person picks the device once.

import { bend, type PadReading } from "./gamepad";

const kVendors = [0x256f, 0x046d]; // 3Dconnexion; Logitech for the older ones
const kFull = 350; // counts at full deflection
const kTranslation = 1; // reports
const kButtons = 3;

interface HidDevice extends EventTarget {
  opened: boolean;
  productName: string;
  open(): Promise<void>;
}

interface HidReport extends Event {
  reportId: number;
  data: DataView;
}

interface Hid {
  requestDevice(options: { filters: object[] }): Promise<HidDevice[]>;
  getDevices(): Promise<HidDevice[]>;
}

export function hid(): Hid | undefined {
  return (navigator as Navigator & { hid?: Hid }).hid;
}

/** A translation report: x right, y towards the person, z down, 16 bits each. */
export function readTranslation(data: DataView): Omit<PadReading, "buttons"> {
  const part = (offset: number) =>
    bend(Math.min(1, Math.max(-1, data.getInt16(offset, true) / kFull)));
  return { right: part(0), up: -part(4), away: -part(2) };
}

export class SpaceMouse {
  private reading: PadReading | undefined;

  /** Opens what the person allowed before; silent where there is nothing. */
  async resume(): Promise<void> {
    for (const device of (await hid()?.getDevices()) ?? []) await this.listen(device);
  }

  /** Asks the person; has to come from a click. The device's name, or undefined. */
  async choose(): Promise<string | undefined> {
    const filters = kVendors.map((vendorId) => ({ vendorId, usagePage: 1, usage: 8 }));
    const [device] = (await hid()?.requestDevice({ filters })) ?? [];
    if (device === undefined) return undefined;
    await this.listen(device);
    return device.productName;
  }

  read(): PadReading | undefined {
    return this.reading;
  }

  private async listen(device: HidDevice): Promise<void> {
    if (!device.opened) await device.open();
    this.reading ??= { right: 0, up: 0, away: 0, buttons: 0 };
    device.addEventListener("inputreport", (event) => this.take(event as HidReport));
  }

  private take({ reportId, data }: HidReport): void {
    const before = this.reading ?? { right: 0, up: 0, away: 0, buttons: 0 };
    if (reportId === kTranslation && data.byteLength >= 6) {
      this.reading = { ...readTranslation(data), buttons: before.buttons };
    } else if (reportId === kButtons && data.byteLength >= 1) {
      this.reading = { ...before, buttons: data.getUint8(0) };
    }
  }
}
