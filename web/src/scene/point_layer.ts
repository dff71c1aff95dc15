/** The points of a frame as one picture with depth: see `point_raster.ts`. */

import { DataTexture, GLSL3, Matrix4, Mesh, PlaneGeometry, RawShaderMaterial, RedIntegerFormat, UnsignedIntType, type PerspectiveCamera } from "three";
import { CUT_BITS, NOTHING, PointRaster } from "./point_raster";
import type { Points } from "./primitives";

const VERTEX = `
  in vec3 position;
  void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const FRAGMENT = `
  precision highp float;
  precision highp int;
  precision highp usampler2D;
  uniform usampler2D words;
  uniform uint baseBits;
  uniform vec2 projection;
  out vec4 colour;
  void main() {
    uint word = texelFetch(words, ivec2(gl_FragCoord.xy), 0).r;
    if (word == ${NOTHING}u) discard;
    float distance = uintBitsToFloat(((word >> 16) << ${CUT_BITS}) + baseBits);
    gl_FragDepth = 0.5 + 0.5 * (projection.y / distance - projection.x);
    colour = vec4(vec3((word >> 11) & 31u, (word >> 5) & 63u, word & 31u) / vec3(31.0, 63.0, 31.0), 1.0);
  }`;

export class PointLayer {
  readonly #raster = new PointRaster();
  readonly #uniforms = { words: { value: textureOf(new Uint32Array([NOTHING]), 1, 1) }, baseBits: { value: 0 }, projection: { value: [0, 0] } };
  readonly #clip_T_fixed = new Matrix4();
  readonly #clip_T_point = new Matrix4();
  readonly object = new Mesh(
    new PlaneGeometry(2, 2),
    new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.#uniforms }),
  );

  constructor() {
    this.object.frustumCulled = false;
  }

  /** Begin a frame of so many pixels. */
  begin(camera: PerspectiveCamera, width: number, height: number): void {
    this.#clip_T_fixed.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const { elements } = camera.projectionMatrix;
    this.#uniforms.projection.value = [elements[10], elements[14]];
    const before = this.#raster.words;
    this.#raster.begin(width, height, camera.near);
    this.#uniforms.baseBits.value = this.#raster.baseBits;
    if (this.#raster.words === before) return;
    this.#uniforms.words.value.dispose();
    this.#uniforms.words.value = textureOf(this.#raster.words, width, height);
  }

  draw(points: Points, fixed_T_part: Matrix4, sizePx: number): void {
    this.#clip_T_point.multiplyMatrices(this.#clip_T_fixed, fixed_T_part);
    this.#raster.draw(points, this.#clip_T_point.elements, sizePx);
  }

  end(): void {
    this.object.visible = this.#raster.hasPoints;
    if (this.#raster.hasPoints) this.#uniforms.words.value.needsUpdate = true;
  }

  dispose(): void {
    this.#uniforms.words.value.dispose();
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}

function textureOf(words: Uint32Array<ArrayBuffer>, width: number, height: number): DataTexture {
  const texture = new DataTexture(words, width, height, RedIntegerFormat, UnsignedIntType);
  texture.internalFormat = "R32UI";
  texture.unpackAlignment = 4;
  return texture;
}
