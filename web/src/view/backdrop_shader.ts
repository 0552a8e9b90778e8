// The passes over the whole picture: one that shades clouds, and one that shows them behind the tools.

const kPairs = 5; // of points that are compared with each (judgement: more take longer than points do)
const kNearest = 1.4; // style-sheet pixels to the nearest of them: edges (judgement)
const kFarthest = 26; // hollows (judgement)
const kDark = 3.5; // of hollows (judgement)

/** A spiral of golden angles. */
function offsets(): string {
  return Array.from({ length: kPairs }, (_, i) => {
    const pixels = kNearest + (kFarthest - kNearest) * (i / (kPairs - 1)) ** 1.5;
    return `vec2(${(pixels * Math.cos(2.4 * i)).toFixed(3)}, ${(pixels * Math.sin(2.4 * i)).toFixed(3)})`;
  }).join(", ");
}

export const kScreen = /* glsl */ `
  out vec2 at;
  void main() {
    at = position.xy + 0.5;
    gl_Position = vec4(2.0 * position.xy, 0.0, 1.0);
  }
`;

/** Fills holes of a pixel, and shades what lies in hollows or behind its neighbours. A depth is linear in the picture
 * where the surface is flat: of two neighbours on opposite sides the mean shows by how much a point lies deeper, however
 * steep its surface is. */
export const kShade = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform float slope; // of a pixel
  uniform float reach; // pixels for one of the style sheet
  uniform float grain; // by which discs stand out of their surface, m
  uniform float turn; // of the pattern, another in each pass, radians
  in vec2 at;
  out vec4 shown;

  const vec2 kWays[${kPairs}] = vec2[](${offsets()}); // style-sheet pixels
  ivec2 last;
  float depth(ivec2 place) { return texelFetch(depths, clamp(place, ivec2(0), last), 0).r; }

  /** What fills a hole: all around but for one are nearer, by more than they differ. */
  bool fill(ivec2 here, inout float own, inout vec3 colour) {
    float least = 1.0, most = 0.0, second = 0.0;
    for (int i = 0; i < 9; i += 1) {
      if (i == 4) continue;
      float d = depth(here + ivec2(i % 3, i / 3) - 1);
      least = min(least, d);
      second = max(second, min(most, d));
      most = max(most, d);
    }
    if (own <= 2.0 * second - least) return false;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 9; i += 1) {
      ivec2 place = clamp(here + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
      if (i != 4 && depth(place) <= second) sum += vec4(texelFetch(colours, place, 0).rgb, 1.0);
    }
    own = 0.5 * (least + second);
    colour = sum.rgb / sum.a;
    return true;
  }

  void main() {
    last = textureSize(depths, 0) - 1;
    ivec2 here = ivec2(gl_FragCoord.xy);
    float own = depth(here);
    vec3 colour = texelFetch(colours, here, 0).rgb;
    // Few are farther than those beside and above: only they may be holes.
    float beside = max(depth(here + ivec2(1, 0)), depth(here - ivec2(1, 0)));
    float above = max(depth(here + ivec2(0, 1)), depth(here - ivec2(0, 1)));
    if (own > min(beside, above)) fill(here, own, colour);
    gl_FragDepth = own;
    shown = vec4(0.0);
    if (own >= 1.0) return;

    // Each pixel begins elsewhere on its spiral (interleaved gradient noise, Jimenez 2014): no ghosts of edges.
    float angle = turn + 6.283 * fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.005837))));
    mat2 turned = reach * mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
    float away = range.x * range.y / (range.y - own * (range.y - range.x)); // m
    float metres = away * away * (range.y - range.x) / (range.x * range.y); // for one of depth
    float hollow = 0.0;
    float edge = 0.0;
    for (int i = 0; i < ${kPairs}; i += 1) {
      ivec2 way = ivec2(round(turned * kWays[i]));
      float deeper = metres * (own - 0.5 * (depth(here + way) + depth(here - way)));
      float x = (deeper - clamp(deeper, -grain, grain)) / (reach * slope * away * length(kWays[i]));
      hollow += x / (1.0 + x * x);
      if (i == 0) edge = max(0.0, x / (1.0 + x));
    }
    hollow /= float(${kPairs});
    float light = hollow > 0.0 ? exp(-${kDark.toFixed(1)} * hollow) : 1.0 - 0.35 * hollow;
    shown = vec4(colour * light * (1.0 - 0.3 * edge), 1.0);
  }
`;

/** With soft shadows below the tools, as a lamp straight above casts them on what is not steep; dents glow. */
export const kShow = /* glsl */ `
  uniform sampler2D colours;
  uniform highp sampler2D depths;
  uniform vec2 range; // near and far, m
  uniform vec2 slopes; // of the picture's edges
  uniform vec3 up;
  uniform vec4 casters[4]; // place, as the eye has it, and radius, m
  uniform float heats[4];
  uniform vec3 hot;
  uniform vec3 ground; // behind all
  uniform vec2 between; // from a pixel's middle to the mean of four
  uniform int count; // of them
  in vec2 at;
  out vec4 shown;
  float depth(vec2 place) { return texture(depths, place).r; }
  vec3 seen(vec2 place) {
    float far = range.x * range.y / (range.y - depth(place) * (range.y - range.x));
    return far * vec3((2.0 * place - 1.0) * slopes, -1.0);
  }

  /** 1 on what is level, 0 on what is steep. */
  float level(vec3 here) {
    vec2 pixel = 1.5 / vec2(textureSize(depths, 0));
    vec3 normal = cross(seen(at + vec2(pixel.x, 0.0)) - here, seen(at + vec2(0.0, pixel.y)) - here);
    return smoothstep(0.1, 0.5, dot(normalize(normal), up));
  }

  void main() {
    vec4 colour = texture(colours, at + between);
    if (colour.a == 0.0) discard; // nothing there: the canvas keeps its ground
    gl_FragDepth = depth(at);
    vec3 here = seen(at);
    float light = 1.0;
    float glow = 0.0;
    for (int i = 0; i < count; i += 1) {
      float radius = casters[i].w;
      vec3 way = casters[i].xyz - here;
      float above = dot(way, up);
      float wide = radius + 0.2 * max(above, 0.0); // softer from higher up (judgement)
      float aside = dot(way, way) - above * above;
      if (aside > 9.0 * wide * wide) continue; // nothing of it shows so far away
      light -= 0.5 * level(here) * smoothstep(-radius, 0.0, above) * (radius / wide) * exp(-aside / (wide * wide));
      glow = max(glow, heats[i] * exp(-0.25 * dot(way, way) / (radius * radius)));
    }
    vec3 lit = mix(colour.rgb * max(light, 0.4), colour.a * hot, 0.8 * glow);
    shown = vec4(lit + (1.0 - colour.a) * ground, 1.0);
  }
`;
