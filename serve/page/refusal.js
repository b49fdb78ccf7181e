// Why no connection was made. A browser tells a page nothing of a refused WebSocket, so the page asks over HTTP.

const REASONS = { 401: "token", 403: "origin", 404: "version", 503: "full" };

// Resolves with {reason, text}: token, origin, version, full, or gone when no server answers; lost for all else.
export async function askForReason(path, query) {
  const fields = new URLSearchParams(query);
  fields.set("origin", location.origin);
  try {
    const answer = await fetch(`${path}?${fields}`, { cache: "no-store", signal: AbortSignal.timeout(5000) });
    return { reason: REASONS[answer.status] ?? "lost", text: (await answer.text()).trim() };
  } catch {
    return { reason: "gone" };
  }
}
