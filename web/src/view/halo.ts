// The support radius: a sphere of which one sees the rim alone.

import { ShaderMaterial, type Color, SRGBColorSpace } from "three";

const kVertex = /* glsl */ `
  varying vec3 facing;
  varying vec3 seen;
  void main() {
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    facing = normalMatrix * normal;
    gl_Position = projectionMatrix * at;
  }
`;

const kFragment = /* glsl */ `
  uniform vec3 colour;
  varying vec3 facing;
  varying vec3 seen;
  void main() {
    float rim = 1.0 - abs(dot(normalize(facing), normalize(seen)));
    gl_FragColor = vec4(colour, 0.03 + 0.4 * pow(rim, 3.5));
  }
`;

export class HaloMaterial extends ShaderMaterial {
  constructor() {
    super({
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: { colour: { value: [0, 0, 0] } },
      transparent: true,
      depthWrite: false,
    });
  }

  tint(colour: Color): void {
    const { r, g, b } = colour.getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace);
    this.uniforms["colour"]!.value = [r, g, b];
  }
}
