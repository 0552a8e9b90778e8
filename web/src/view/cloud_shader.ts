// Points as small disks that lie in the surface where there are normals. Colours are screen colours:
// the shader mixes and shades them as they are.

export const kCloudVertex = /* glsl */ `
  uniform int mode;
  uniform bool hasNormals;
  uniform vec3 sourceColour;
  uniform float age;        // 0 fresh to 1 stale
  uniform bool faded;       // cannot be felt any more: grey
  uniform vec2 heights;     // low, high
  uniform vec3 up;
  uniform float disc;       // radius of a point's disc, in R
  uniform float wider;      // where some points stand for all
  uniform float tall;       // the picture, pixels
  uniform sampler2D ramps;
  in vec2 bend;      // octahedral normal
  in vec3 own;
  in float trust;
  in float wide;     // R, as radiusOf() reads it
  flat out float radius; // of the disc, m
  flat out vec3 deep;    // its middle's depth, and what makes a distance a depth
  out vec3 colour;
  out vec3 facing;

  vec3 unbend(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    return normalize(n);
  }

  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    vec4 seen = viewMatrix * world;
    gl_Position = projectionMatrix * seen;
    radius = disc * wider * exp2((wide - 160.0) / 8.0);
    gl_PointSize = max(radius * tall * projectionMatrix[1][1] / -seen.z, 1.5);
    deep = vec3(seen.z, projectionMatrix[2][2], projectionMatrix[3][2]);

    bool isSurface = hasNormals && trust > 0.5; // others have no direction of their own
    vec3 normal = isSurface ? unbend(bend) : up;
    if (mode == 1) {
      float h = (dot(world.xyz, up) - heights.x) / max(heights.y - heights.x, 1e-9);
      colour = texture(ramps, vec2(clamp(h, 0.0, 1.0) * 0.996 + 0.002, 0.5 / 3.0)).rgb;
    } else if (mode == 2 && hasNormals) {
      colour = 0.5 + 0.5 * normal;
    } else if (mode == 3) {
      colour = texture(ramps, vec2(age * 0.996 + 0.002, 1.5 / 3.0)).rgb;
    } else if (mode == 4) {
      colour = own;
    } else if (mode == 5) {
      colour = texture(ramps, vec2(trust * 0.996 + 0.002, 2.5 / 3.0)).rgb;
    } else {
      colour = sourceColour;
    }

    if (faded) colour = vec3(0.35 + 0.3 * dot(colour, vec3(0.3, 0.6, 0.1)));

    facing = vec3(0.0, 0.0, 1.0);
    if (hasNormals) {
      facing = mat3(viewMatrix) * normal;
      if (dot(facing, seen.xyz) > 0.0) facing = -facing;
      vec3 light = normalize(vec3(0.4, 0.75, 0.55));
      float shade = 0.6 + 0.48 * dot(facing, light); // as of a sky: no face is black
      colour *= mode == 2 || mode == 4 ? mix(1.0, shade, 0.35) : shade;
    }
    if (!isSurface) facing = vec3(0.0, 0.0, 1.0);
  }
`;

export const kCloudFragment = /* glsl */ `
  out vec4 shown;
  flat in float radius;
  flat in vec3 deep;
  in vec3 colour;
  in vec3 facing;

  void main() {
    vec2 p = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
    float slope = dot(facing.xy, p) / max(facing.z, 0.35);
    float edge = dot(p, p) + slope * slope;
    #ifdef SOFT
    float soft = fwidth(edge); // takes half of the time where the processor draws
    float share = (1.0 + soft - edge) / (2.0 * soft);
    #else
    float share = edge > 1.0 ? 0.0 : 1.0;
    #endif
    if (share <= 0.0) discard;
    float z = deep.x - radius * slope; // a disc lies in its plane: neighbours' meet where their planes do
    gl_FragDepth = 0.5 - 0.5 * (deep.y + deep.z / z);
    shown = vec4(colour, min(share, 1.0));
  }
`;
