/** Services of a server, and calls that wait for their responses. */

import type { Service, ServiceCallPayload } from "@foxglove/ws-protocol";
import { decoderOf, encoderOf } from "./codec";

interface Pending {
  readonly service: Service;
  readonly resolve: (value: never) => void;
  readonly reject: (reason: Error) => void;
}

export class ServiceCalls {
  readonly #services = new Map<number, Service>();
  readonly #pending = new Map<number, Pending>();
  #types: ReadonlyMap<string, string> = new Map();
  #calls = 0;

  get types(): ReadonlyMap<string, string> {
    return this.#types;
  }

  advertise(services: readonly Service[]): void {
    for (const service of services) this.#services.set(service.id, service);
    this.#sort();
  }

  unadvertise(ids: readonly number[]): void {
    for (const id of ids) this.#services.delete(id);
    this.#sort();
  }

  /** The frame of a call, and the promise of its response. */
  begin(name: string, request: object): { payload: ServiceCallPayload; response: Promise<never> } {
    const service = [...this.#services.values()].find((each) => each.name === name);
    if (!service) throw new Error(`no service ${name}`);
    const data = encoderOf(requestSchema(service)).encode(request);
    const callId = (this.#calls += 1);
    const response = new Promise<never>((resolve, reject) => this.#pending.set(callId, { service, resolve, reject }));
    return { payload: { serviceId: service.id, callId, encoding: "cdr", data }, response };
  }

  respond(callId: number, data: ArrayBufferView): void {
    const pending = this.#take(callId);
    if (!pending) return;
    const { service, resolve, reject } = pending;
    try {
      resolve(decoderOf(responseSchema(service)).decode(data) as never);
    } catch (error) {
      reject(error instanceof Error ? error : new Error(String(error)));
    }
  }

  fail(callId: number, message: string): void {
    this.#take(callId)?.reject(new Error(message));
  }

  clear(): void {
    this.#services.clear();
    this.#sort();
    for (const { reject } of this.#pending.values()) reject(new Error("not connected"));
    this.#pending.clear();
  }

  #take(callId: number): Pending | undefined {
    const pending = this.#pending.get(callId);
    this.#pending.delete(callId);
    return pending;
  }

  #sort(): void {
    const sorted = [...this.#services.values()].sort((a, b) => a.name.localeCompare(b.name));
    this.#types = new Map(sorted.map(({ name, type }) => [name, type]));
  }
}

function requestSchema(service: Service): string {
  // eslint-disable-next-line @typescript-eslint/no-deprecated -- servers from before 2024
  return service.request?.schema ?? service.requestSchema ?? "";
}

function responseSchema(service: Service): string {
  // eslint-disable-next-line @typescript-eslint/no-deprecated -- servers from before 2024
  return service.response?.schema ?? service.responseSchema ?? "";
}
