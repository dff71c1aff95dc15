/** Meshes that the server serves: STL files, fetched once. */

import type { Connection } from "../../connection/connection";
import type { Mesh } from "../primitives";

export class MeshStore {
  readonly #meshes = new Map<string, Mesh | null>();
  /** URI → why it is missing. */
  readonly #missing = new Map<string, string>();

  constructor(
    private readonly connection: Connection,
    private readonly onLoad: () => void,
  ) {}

  /** The mesh, or null while it is loaded or if it cannot be. */
  get(uri: string): Mesh | null {
    const known = this.#meshes.get(uri);
    if (known !== undefined) return known;
    this.#meshes.set(uri, null);
    if (!/\.stl$/i.test(uri)) {
      this.#missing.set(uri, "not an STL file");
      return null;
    }
    this.connection.fetchAsset(uri).then(
      (bytes) => {
        this.#meshes.set(uri, readStl(bytes));
        this.onLoad();
      },
      (error: unknown) => this.#missing.set(uri, error instanceof Error ? error.message : String(error)),
    );
    return null;
  }

  /** Which meshes are missing and why; empty if none is. */
  get problem(): string {
    const [first] = this.#missing;
    if (!first) return "";
    const more = this.#missing.size - 1;
    return `no mesh ${first[0].split("/").at(-1) ?? ""}: ${first[1]}${more > 0 ? `, and ${more} more` : ""}`;
  }
}

/** Triangles of a binary or a text STL file. */
export function readStl(bytes: ArrayBuffer): Mesh {
  const view = new DataView(bytes);
  const count = bytes.byteLength >= 84 ? view.getUint32(80, true) : 0;
  if (bytes.byteLength === 84 + 50 * count) {
    const positions = new Float32Array(9 * count);
    for (let triangle = 0; triangle < count; triangle++) {
      for (let part = 0; part < 9; part++) positions[9 * triangle + part] = view.getFloat32(84 + 50 * triangle + 12 + 4 * part, true);
    }
    return { positions };
  }
  const text = new TextDecoder().decode(bytes);
  const numbers = [...text.matchAll(/vertex\s+(\S+)\s+(\S+)\s+(\S+)/g)].flatMap((found) => found.slice(1, 4).map(Number));
  return { positions: Float32Array.from(numbers) };
}
