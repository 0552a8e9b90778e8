// The clouds as a picture with depths that is kept while they and the eye stand still: only what is before it is
// drawn anew then. Edges are shaded by depth (eye-dome lighting, Boucheny 2009), so that forms show without normals.

import {
  AlwaysDepth, DepthTexture, GLSL3, Mesh, NearestFilter, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, UnsignedIntType,
  Vector3, Vector4, WebGLRenderTarget, type IUniform, type PerspectiveCamera, type WebGLRenderer,
} from "three";

import { screenColour } from "./colours";

export const kCloudLayer = 1; // of what is drawn into the backdrop
const kPairs = 10; // of places that are compared with each
const kHollow = 28; // style-sheet pixels to the farthest of them (judgement)
const kDark = 3.5; // of hollows (judgement)

const kVertex = /* glsl */ `
  out vec2 at;
  void main() {
    at = position.xy + 0.5;
    gl_Position = vec4(2.0 * position.xy, 0.0, 1.0);
  }
`;

/** Fills holes of a pixel, and shades what lies in hollows or behind its neighbours. A depth is linear in the picture
 * where the surface is flat: of two neighbours on opposite sides the mean tells by how much a place lies deeper, however
 * steep its surface is. */
const kShade = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform float slope; // of a pixel
  uniform float reach; // pixels for one of the style sheet
  uniform float grain; // by which discs stand out of their surface, m
  in vec2 at;
  out vec4 shown;

  ivec2 last;
  float depth(ivec2 place) { return texelFetch(depths, clamp(place, ivec2(0), last), 0).r; }
  float far(float d) { return range.x * range.y / (range.y - d * (range.y - range.x)); }

  void main() {
    last = textureSize(depths, 0) - 1;
    ivec2 here = ivec2(gl_FragCoord.xy);
    float own = depth(here);
    vec3 colour = texelFetch(colours, here, 0).rgb;

    // A hole: all around but for one are nearer, by more than they differ.
    float least = 1.0, most = 0.0, second = 0.0;
    for (int i = 0; i < 9; i += 1) {
      if (i == 4) continue;
      float d = depth(here + ivec2(i % 3, i / 3) - 1);
      least = min(least, d);
      second = max(second, min(most, d));
      most = max(most, d);
    }
    if (own > 2.0 * second - least) {
      own = 0.5 * (least + second);
      vec3 sum = vec3(0.0);
      float count = 0.0;
      for (int i = 0; i < 9; i += 1) {
        ivec2 place = clamp(here + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        if (i == 4 || depth(place) > second) continue;
        sum += texelFetch(colours, place, 0).rgb;
        count += 1.0;
      }
      colour = sum / count;
    }
    gl_FragDepth = own;
    if (own >= 1.0) {
      shown = vec4(0.0);
      return;
    }

    // Each pixel begins elsewhere on its spiral (interleaved gradient noise, Jimenez 2014): no ghosts of edges.
    float turn = 6.283 * fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.005837))));
    float away = far(own);
    float hollow = 0.0;
    float edge = 0.0;
    for (int i = 0; i < ${kPairs}; i += 1) {
      float part = (float(i) + 0.5) / float(${kPairs});
      float pixels = reach * mix(1.4, ${kHollow.toFixed(1)}, part * part);
      float angle = turn + 2.4 * float(i); // the golden one: places all around
      ivec2 way = ivec2(round(pixels * vec2(cos(angle), sin(angle))));
      float between = 0.5 * (depth(here + way) + depth(here - way));
      float deeper = away - far(between); // m
      float x = (deeper - sign(deeper) * min(abs(deeper), grain)) / (pixels * slope * away);
      hollow += x / (1.0 + x * x);
      if (i < 2) edge += 0.5 * max(0.0, x / (1.0 + x));
    }
    hollow /= float(${kPairs});
    float light = hollow > 0.0 ? exp(-${kDark.toFixed(1)} * hollow) : 1.0 - 0.35 * hollow;
    shown = vec4(colour * light * (1.0 - 0.3 * edge), 1.0);
  }
`;

/** With soft shadows below the tools, as a lamp straight above casts them on what is not steep; dents glow. */
const kShow = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform vec2 slopes; // of the picture's edges
  uniform vec3 up;
  uniform vec4 casters[4]; // place, as the eye has it, and radius, m
  uniform float heats[4];
  uniform vec3 hot;
  uniform int count; // of them
  in vec2 at;
  out vec4 shown;
  void main() {
    float depth = texture(depths, at).r;
    float far = 2.0 * range.x * range.y / (range.y + range.x - (2.0 * depth - 1.0) * (range.y - range.x));
    vec3 seen = far * vec3((2.0 * at - 1.0) * slopes, -1.0);
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    if (depth >= 1.0) discard; // nothing there: the canvas keeps its ground
    gl_FragDepth = depth;
    float level = smoothstep(0.1, 0.5, dot(normal, up));
    float light = 1.0;
    float glow = 0.0;
    for (int i = 0; i < count; i += 1) {
      float radius = casters[i].w;
      vec3 way = casters[i].xyz - seen;
      float above = dot(way, up);
      float wide = radius + 0.2 * max(above, 0.0); // softer from higher up (judgement)
      float aside = dot(way, way) - above * above;
      light -= 0.5 * level * smoothstep(-radius, 0.0, above) * (radius / wide) * exp(-aside / (wide * wide));
      glow = max(glow, heats[i] * exp(-0.25 * dot(way, way) / (radius * radius)));
    }
    shown = vec4(mix(texture(colours, at).rgb * max(light, 0.4), hot, 0.8 * glow), 1.0);
  }
`;

function screen(fragmentShader: string, uniforms: Record<string, IUniform>): Mesh<PlaneGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: kVertex, fragmentShader, uniforms, depthFunc: AlwaysDepth });
  const mesh = new Mesh(new PlaneGeometry(1, 1), material);
  mesh.frustumCulled = false;
  return mesh;
}

/** What throws a shadow, and lets what it touches glow. */
export interface Caster {
  place: Vector3;
  radius: number; // m
  heat: number; // 0 to 1
}

export interface Wanted {
  sharpness: number; // pixels drawn for one of the style sheet
  clouds: string; // changes with what is seen of them
  grain: number; // size of a point's disk, m
  rest: number; // ms
}

export class Backdrop {
  private readonly points: WebGLRenderTarget;
  private readonly shaded = new WebGLRenderTarget(1, 1, {
    depthTexture: new DepthTexture(1, 1, UnsignedIntType), minFilter: NearestFilter, magFilter: NearestFilter,
  });
  private readonly shade: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly shading = new Scene();
  private readonly flat = new OrthographicCamera();
  private readonly range = { value: [0, 1] };
  private readonly casters = [0, 1, 2, 3].map(() => new Vector4());
  private readonly heats = [0, 0, 0, 0];
  private eye = "";
  private clouds = "";
  private drawn = -Infinity; // ms
  /** Puts the picture, with its depths, behind all that a scene draws. */
  readonly screen: Mesh<PlaneGeometry, ShaderMaterial>;

  /** samples: of a pixel, for soft edges; 0: none. */
  constructor(samples: number) {
    const depthTexture = new DepthTexture(1, 1, UnsignedIntType);
    this.points = new WebGLRenderTarget(1, 1, { depthTexture, samples, minFilter: NearestFilter, magFilter: NearestFilter });
    const depths = { value: depthTexture };
    this.shade = screen(kShade, { colours: { value: this.points.texture }, depths, range: this.range, slope: { value: 0 }, reach: { value: 1 }, grain: { value: 0 } });
    this.shading.add(this.shade);
    this.screen = screen(kShow, {
      colours: { value: this.shaded.texture }, depths: { value: this.shaded.depthTexture }, range: this.range, slopes: { value: [1, 1] }, up: { value: new Vector3() },
      casters: { value: this.casters }, heats: { value: this.heats }, hot: { value: [0, 0, 0] }, count: { value: 0 },
    });
    this.screen.renderOrder = -1;
  }

  retint(): void {
    this.screen.material.uniforms["hot"]!.value = screenColour("--force");
  }

  /** Draws the clouds of a scene, unless `clouds` and eye are as they were. While the eye stands still, clouds that
   * change wait until `rest` ms have passed. */
  update(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, { sharpness, clouds, grain, rest }: Wanted): void {
    const { width, height } = renderer.domElement;
    camera.updateMatrixWorld();
    const eye = [width, height, ...camera.matrixWorld.elements, ...camera.projectionMatrix.elements].join();
    const now = performance.now();
    if (eye === this.eye && (clouds === this.clouds || now - this.drawn < rest)) return;
    this.eye = eye;
    this.clouds = clouds;
    this.drawn = now;
    this.points.setSize(width, height);
    this.shaded.setSize(width, height);
    camera.layers.set(kCloudLayer);
    renderer.setRenderTarget(this.points);
    renderer.render(scene, camera);
    camera.layers.set(0);
    this.range.value = [camera.near, camera.far];
    this.shade.material.uniforms["grain"]!.value = grain;
    this.shade.material.uniforms["reach"]!.value = sharpness;
    this.shade.material.uniforms["slope"]!.value = 2 / (camera.projectionMatrix.elements[5] * height);
    renderer.setRenderTarget(this.shaded);
    renderer.render(this.shading, this.flat);
    renderer.setRenderTarget(null);
  }

  /** Shadows of these, before the next picture. */
  cast(camera: PerspectiveCamera, up: Vector3, casters: readonly Caster[]): void {
    const { uniforms } = this.screen.material;
    const projection = camera.projectionMatrix.elements;
    uniforms["slopes"]!.value = [1 / projection[0], 1 / projection[5]];
    (uniforms["up"]!.value as Vector3).copy(up).transformDirection(camera.matrixWorldInverse);
    uniforms["count"]!.value = Math.min(casters.length, this.casters.length);
    casters.slice(0, this.casters.length).forEach(({ place, radius, heat }, i) => {
      this.heats[i] = heat;
      this.casters[i]!.set(...place.clone().applyMatrix4(camera.matrixWorldInverse).toArray(), radius);
    });
  }
}
