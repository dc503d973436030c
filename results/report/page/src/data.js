// The run's data: a JSON text in the page, and binary blocks beside it (docs/report.md).

export const report = JSON.parse(document.getElementById('report-data').textContent);

/** The bytes of a block: base64 of a gzip stream. */
export async function block(name) {
  const text = document.getElementById(name).textContent;
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}
