// The clouds as a picture with depths that is kept while they and the eye stand still: only what is before it is
// drawn anew then. Edges are shaded by depth (eye-dome lighting, Boucheny 2009), so that forms show without normals.

import {
  DepthTexture, GLSL3, Mesh, NearestFilter, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, UnsignedIntType,
  Vector3, Vector4, WebGLRenderTarget, type IUniform, type PerspectiveCamera, type WebGLRenderer,
} from "three";

export const kCloudLayer = 1; // of what is drawn into the backdrop

const kVertex = /* glsl */ `
  out vec2 at;
  void main() {
    at = position.xy + 0.5;
    gl_Position = vec4(2.0 * position.xy, 0.0, 1.0);
  }
`;

/** Darkens what lies behind its neighbours in the picture, by the logarithm of how far. */
const kShade = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform float reach; // pixels
  uniform float grain; // size of a point's disk, m
  in vec2 at;
  out vec4 shown;

  float far(vec2 place) {
    float z = 2.0 * texture(depths, place).r - 1.0;
    return log2(2.0 * range.x * range.y / (range.y + range.x - z * (range.y - range.x)));
  }

  void main() {
    vec2 step = reach / vec2(textureSize(depths, 0));
    float own = far(at);
    own -= grain * exp2(-own) * 1.4427; // disks that lie in one surface overlap: that is no edge
    float behind = max(0.0, own - far(at + vec2(step.x, 0.0))) + max(0.0, own - far(at - vec2(step.x, 0.0))) +
      max(0.0, own - far(at + vec2(0.0, step.y))) + max(0.0, own - far(at - vec2(0.0, step.y)));
    shown = vec4(texture(colours, at).rgb * max(0.45, exp(-12.0 * behind)), 1.0);
  }
`;

/** With soft shadows below the tools, as a lamp straight above casts them. */
const kShow = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform vec2 slopes; // of the picture's edges
  uniform vec3 up;
  uniform vec4 casters[4]; // place, as the eye has it, and radius, m
  uniform int count; // of them
  in vec2 at;
  out vec4 shown;
  void main() {
    float depth = texture(depths, at).r;
    if (depth >= 1.0) discard; // nothing there: the canvas keeps its ground
    gl_FragDepth = depth;
    float far = 2.0 * range.x * range.y / (range.y + range.x - (2.0 * depth - 1.0) * (range.y - range.x));
    vec3 seen = far * vec3((2.0 * at - 1.0) * slopes, -1.0);
    float light = 1.0;
    for (int i = 0; i < count; i += 1) {
      float radius = casters[i].w;
      vec3 way = casters[i].xyz - seen;
      float above = dot(way, up);
      float wide = radius + 0.2 * max(above, 0.0); // softer from higher up (judgement)
      float aside = dot(way, way) - above * above;
      light -= 0.5 * smoothstep(-radius, 0.0, above) * (radius / wide) * exp(-aside / (wide * wide));
    }
    shown = vec4(texture(colours, at).rgb * max(light, 0.4), 1.0);
  }
`;

const kReach = 1.4; // style-sheet pixels to the neighbours that are compared (judgement)

function screen(fragmentShader: string, uniforms: Record<string, IUniform>): Mesh<PlaneGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: kVertex, fragmentShader, uniforms });
  const mesh = new Mesh(new PlaneGeometry(1, 1), material);
  mesh.frustumCulled = false;
  return mesh;
}

/** What throws a shadow. */
export interface Caster {
  place: Vector3;
  radius: number; // m
}

export interface Wanted {
  sharpness: number; // pixels drawn for one of the style sheet
  clouds: string; // changes with what is seen of them
  grain: number; // size of a point's disk, m
  rest: number; // ms
}

export class Backdrop {
  private readonly points: WebGLRenderTarget;
  private readonly shaded = new WebGLRenderTarget(1, 1, { depthBuffer: false, minFilter: NearestFilter, magFilter: NearestFilter });
  private readonly shade: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly shading = new Scene();
  private readonly flat = new OrthographicCamera();
  private readonly range = { value: [0, 1] };
  private readonly casters = [0, 1, 2, 3].map(() => new Vector4());
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
    this.shade = screen(kShade, { colours: { value: this.points.texture }, depths, range: this.range, reach: { value: 1 }, grain: { value: 0 } });
    this.shading.add(this.shade);
    this.screen = screen(kShow, {
      colours: { value: this.shaded.texture }, depths, range: this.range, slopes: { value: [1, 1] }, up: { value: new Vector3() },
      casters: { value: this.casters }, count: { value: 0 },
    });
    this.screen.renderOrder = -1;
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
    this.shade.material.uniforms["reach"]!.value = kReach * sharpness;
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
    casters.slice(0, this.casters.length).forEach(({ place, radius }, i) => {
      this.casters[i]!.set(...place.clone().applyMatrix4(camera.matrixWorldInverse).toArray(), radius);
    });
  }
}
