// What draws: a graphics card, or the processor.

export interface Graphics {
  software: boolean; // pictures are computed by the processor: soft edges cost too much there
}

/** Undefined where the browser has no WebGL 2. */
export function graphics(): Graphics | undefined {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (gl === null) return undefined;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { software: /swiftshader|llvmpipe|software|basic render/i.test(name) };
}
