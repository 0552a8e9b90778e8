// The implicit surface close to the proxy, as the program meshes it: a soft patch that fades outward.

import {
  BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Mesh, ShaderMaterial, Vector3,
} from "three";
import type { SurfaceMessage } from "../protocol/decode";
import { screenColour } from "./colours";

const kVertex = /* glsl */ `
  out vec3 seen;
  out vec3 local;
  void main() {
    local = position;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    gl_Position = projectionMatrix * at;
  }
`;

const kFragment = /* glsl */ `
  uniform vec3 colour;
  in vec3 seen;
  in vec3 local;
  out vec4 shown;
  void main() {
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float light = 0.62 + 0.45 * abs(dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
    float fade = 1.0 - smoothstep(0.45, 1.0, length(local));
    float rings = smoothstep(0.42, 0.5, abs(fract(length(local) * 6.0) - 0.5));
    shown = vec4(colour * light, fade * (0.42 + 0.22 * rings));
  }
`;

export class Surface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  shown = true;
  private readonly place = new Vector3();
  private some = false; // a surface without vertices says that nothing is near

  constructor() {
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: { colour: { value: [0, 0, 0] } },
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
  }

  take(message: SurfaceMessage): void {
    this.some = message.triangles.length > 0;
    if (!this.some) return;
    const geometry = this.mesh.geometry;
    geometry.dispose();
    geometry.setAttribute("position", new BufferAttribute(message.vertices, 3, true));
    geometry.setIndex(new BufferAttribute(message.triangles, 1));
    this.place.set(...message.centre);
    this.mesh.scale.setScalar(Math.max(message.extent, 1e-9));
  }

  /** lift: towards the eye, above the points that lie in the surface, m. */
  update(eye: Vector3, lift: number): void {
    this.mesh.visible = this.shown && this.some;
    const towards = eye.clone().sub(this.place).normalize();
    this.mesh.position.copy(this.place).addScaledVector(towards, lift);
  }
}
