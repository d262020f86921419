/** Why a connection ended, in words for people. */

const kCloseWords: Record<number, string> = {
  1000: 'the server said good-bye',
  1001: 'the server is stopping',
  1002: 'the server saw a break of the WebSocket protocol',
  1003: 'the server saw a message of a kind it does not take',
  1006: 'the connection broke',
  1007: 'the server saw text that is not UTF-8',
  1008: 'the server closed by its policy',
  1009: 'a message was too long for the server',
  1011: 'the server had a fault of its own',
};

export function explainClose(code: number, reason: string, lastError: string | null): string {
  const words = kCloseWords[code] ?? `the connection was closed with code ${code}`;
  const detail = reason || (code === 1006 ? '' : (lastError ?? ''));
  return detail ? `${words}: ${detail}` : words;
}

/** The subprotocol that carries a token: browsers cannot set headers on a WebSocket. */
export function asBearer(token: string): string {
  const bytes = new TextEncoder().encode(token);
  const base64 = btoa(String.fromCharCode(...bytes));
  return 'bearer.' + base64.replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

/**
 * A browser does not tell why a WebSocket handshake failed. An HTTP question to the same server does: null when nobody
 * answers, otherwise why the handshake was likely refused.
 */
export async function probeServer(socketUrl: string): Promise<{ reason: string; hopeless: boolean } | null> {
  const ready = new URL('readyz', socketUrl.replace(/^ws/, 'http'));
  try {
    const reply = await fetch(ready, { cache: 'no-store', signal: AbortSignal.timeout(3000) });
    if (reply.status === 401 || reply.status === 403)
      return { reason: 'the token is missing or wrong', hopeless: true };
    const text = (await reply.text()).trim().slice(0, 120);
    if (reply.status === 503) return { reason: text || 'the server is not ready', hopeless: false };
    return {
      reason: 'the server is up but refuses the connection: no valid token, a foreign origin, or too many clients',
      hopeless: false,
    };
  } catch {
    return null;
  }
}
