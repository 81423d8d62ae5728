// Collects WebGL's errors.

/** Names every pending error of a context. Leaves none for the next call to find. */
export function glErrors(gl) {
  const found = [];
  for (let error = gl.getError(); error !== gl.NO_ERROR; error = gl.getError()) {
    found.push(`GL error 0x${error.toString(16)}`);
    // Ends where the context is lost: it would tell so for ever.
    if (error === gl.CONTEXT_LOST_WEBGL) break;
  }
  return found;
}
