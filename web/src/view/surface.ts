// The implicit surface close to the proxy, as the program meshes it: a soft patch that fades outward.

import {
  BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Mesh, ShaderMaterial, Vector3,
} from "three";
import type { SurfaceMessage } from "../protocol/decode";
import { screenColour } from "./colours";

const kVertex = /* glsl */ `
  uniform vec3 proxy; // of the tool, in the patch's units
  uniform float wide;
  out vec3 seen;
  out vec3 local;
  out float pressed; // 1 under the tool to 0
  void main() {
    local = position;
    pressed = exp(-dot(position - proxy, position - proxy) / (wide * wide));
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    gl_Position = projectionMatrix * at;
  }
`;

const kFragment = /* glsl */ `
  uniform vec3 colour;
  uniform vec3 hot;
  uniform float force; // 0 to 1
  in vec3 seen;
  in vec3 local;
  in float pressed;
  out vec4 shown;
  void main() {
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float light = 0.62 + 0.45 * abs(dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
    float fade = 1.0 - smoothstep(0.45, 1.0, length(local));
    float rings = smoothstep(0.42, 0.5, abs(fract(length(local) * 6.0) - 0.5));
    float heat = force * pressed;
    shown = vec4(mix(colour, hot, heat) * light, fade * mix(0.42 + 0.22 * rings, 0.85, heat));
  }
`;

const kWide = 0.28; // of the patch, where a press shows (judgement)

export class Surface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  shown = true;
  private readonly centre = new Vector3();
  private readonly proxy = new Vector3(); // in the patch's units
  private some = false; // a surface without vertices means that nothing is near

  constructor() {
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: {
        colour: { value: [0, 0, 0] }, hot: { value: [0, 0, 0] }, force: { value: 0 },
        proxy: { value: this.proxy }, wide: { value: kWide },
      },
      side: DoubleSide,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
    this.retint();
  }

  retint(): void {
    this.mesh.material.uniforms["colour"]!.value = screenColour("--disk");
    this.mesh.material.uniforms["hot"]!.value = screenColour("--force");
  }

  take(message: SurfaceMessage): void {
    this.some = message.triangles.length > 0;
    if (!this.some) return;
    const geometry = this.mesh.geometry;
    geometry.dispose();
    geometry.setAttribute("position", new BufferAttribute(message.vertices, 3, true));
    geometry.setIndex(new BufferAttribute(message.triangles, 1));
    this.centre.set(...message.centre);
    this.mesh.scale.setScalar(Math.max(message.extent, 1e-9));
  }

  /** Colours it under the proxy by the force there. */
  press(tool: { proxyPosition: Vector3; heat: number }): void {
    this.proxy.copy(tool.proxyPosition).sub(this.centre).divideScalar(this.mesh.scale.x);
    this.mesh.material.uniforms["force"]!.value = tool.heat;
  }

  /** lift: towards the eye, above the points that lie in the surface, m. */
  update(eye: Vector3, lift: number): void {
    this.mesh.visible = this.shown && this.some;
    const towards = eye.clone().sub(this.centre).normalize();
    this.mesh.position.copy(this.centre).addScaledVector(towards, lift);
  }
}
