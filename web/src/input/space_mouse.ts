// A SpaceMouse through WebHID, where the browser has it: the person picks the device once.

import { bend, type PadReading } from "./gamepad";

const kVendors = [0x256f, 0x046d]; // 3Dconnexion; Logitech for the older ones
const kFull = 350; // counts at full deflection
const kTranslation = 1; // reports; of newer ones with the rotation behind it
const kRotation = 2;
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

const kRest: PadReading = { right: 0, up: 0, away: 0, depth: 0, turn: [0, 0, 0], open: 0, buttons: 0 };

function part(data: DataView, offset: number): number {
  return bend(Math.min(1, Math.max(-1, data.getInt16(offset, true) / kFull)));
}

/** A translation report: x right, y towards the person, z down, 16 bits each. */
export function readTranslation(data: DataView): Pick<PadReading, "right" | "up" | "away" | "depth"> {
  const away = -part(data, 2);
  return { right: part(data, 0), up: -part(data, 4), away, depth: away };
}

/** Turns about the same axes, from an offset on. */
export function readRotation(data: DataView, offset: number): PadReading["turn"] {
  return [part(data, offset), -part(data, offset + 4), part(data, offset + 2)];
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
    this.reading ??= kRest;
    device.addEventListener("inputreport", (event) => this.take(event as HidReport));
  }

  private take({ reportId, data }: HidReport): void {
    const before = this.reading ?? kRest;
    if (reportId === kTranslation && data.byteLength >= 6) {
      const turn = data.byteLength >= 12 ? readRotation(data, 6) : before.turn;
      this.reading = { ...before, ...readTranslation(data), turn };
    } else if (reportId === kRotation && data.byteLength >= 6) {
      this.reading = { ...before, turn: readRotation(data, 0) };
    } else if (reportId === kButtons && data.byteLength >= 1) {
      this.reading = { ...before, buttons: data.getUint8(0) };
    }
  }
}
