const kMissing = '–';

/** A number for people: `digits` significant digits, no exponent between 1e-4 and 1e6, no trailing zeros. */
export function formatNumber(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return kMissing;
  if (value === 0) return '0';
  const magnitude = Math.abs(value);
  if (magnitude < 1e-4 || magnitude >= 1e6) return value.toExponential(Math.max(0, digits - 2));
  return String(Number(value.toPrecision(digits)));
}

/** An error for people: two significant digits, with an exponent below a hundredth. */
export function formatError(value: number): string {
  if (!Number.isFinite(value)) return kMissing;
  return value >= 0.01 || value === 0 ? String(Number(value.toPrecision(2))) : value.toExponential(1);
}

/** An estimated error with its 95 % interval. One of 0 says only what the error is under. */
export function formatInterval(error: number, low: number, high: number): string {
  if (!Number.isFinite(error) || !Number.isFinite(high)) return 'not known yet';
  if (error === 0 && high > 0) return `under ${formatError(high)}`;
  return `${formatError(error)} (${formatError(low)}–${formatError(high)})`;
}

/** Samples per pixel: whole from ten on. */
export function formatSamples(value: number): string {
  return value >= 10 ? formatCount(value) : formatNumber(value, 2);
}

export function formatSeconds(seconds: number): string {
  if (!Number.isFinite(seconds)) return kMissing;
  if (seconds < 10) return `${seconds.toFixed(2)} s`;
  if (seconds < 60) return `${seconds.toFixed(1)} s`;
  return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
}

export function formatMilliseconds(ms: number): string {
  if (!Number.isFinite(ms)) return kMissing;
  if (ms >= 9999.5) return formatSeconds(ms / 1000);
  return ms < 10 ? `${ms.toFixed(1)} ms` : `${Math.round(ms)} ms`;
}

export function formatBytes(bytes: number): string {
  if (!Number.isFinite(bytes)) return kMissing;
  const units = ['B', 'kB', 'MB', 'GB'];
  let value = bytes;
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit++;
  }
  return `${unit === 0 ? Math.round(value) : value.toPrecision(3)} ${units[unit]}`;
}

export function formatCount(value: number): string {
  return Number.isFinite(value) ? Math.round(value).toLocaleString('en') : kMissing;
}

const kSpellings: Record<string, string> = {
  pbr: 'PBR',
  aces: 'ACES',
  agx: 'AgX',
  ior: 'IOR',
  uv: 'UV',
  vpl: 'VPL',
  exr: 'EXR',
};

/** "baseColor" → "Base color": what people read for a name of the wire. */
export function titleFromName(name: string): string {
  const words = name
    .replace(/[-_]/g, ' ')
    .replace(/([a-z0-9])([A-Z])/g, '$1 $2')
    .toLowerCase()
    .trim()
    .split(/\s+/);
  const title = words.map((word) => kSpellings[word] ?? word).join(' ');
  return title.charAt(0).toUpperCase() + title.slice(1);
}
